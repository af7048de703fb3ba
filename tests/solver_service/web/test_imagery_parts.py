"""Pictures of the terrain from a case file to a client, over a real service."""

import io
from pathlib import Path

import numpy as np
from PIL import Image

import protocol
from bench.service_process import ServiceClient, ServiceProcess
from tests.end_to_end.dam_break import CELLS, write_dam_break
from viewer.app.terrain_pictures import decode_imagery, decode_walls


def write_case_with_pictures(folder: Path, name: str = "with-pictures") -> Path:
    """A dam break without data in its north-eastern corner and with imagery: its southern half red."""
    write_dam_break(folder, name=name)
    arrays = dict(np.load(folder / "terrain.npz"))
    arrays["bed"][-20:, -30:] = np.nan
    np.savez(folder / "terrain.npz", **arrays)
    imagery = np.zeros((1200, 1200, 3), np.uint8)
    imagery[600:, :, 0] = 255
    # Noise does not compress: the picture takes several parts.
    imagery[:600] = np.random.default_rng(1).integers(0, 256, (600, 1200, 3), dtype=np.uint8)
    Image.fromarray(imagery).save(folder / "ortho.png")
    case = folder / "case.toml"
    text = case.read_text(encoding="utf-8").replace("[terrain]\n", '[terrain]\nimagery = "ortho.png"\n')
    case.write_text(text, encoding="utf-8")
    return folder


def fetch(client: ServiceClient, run: str, layer: str) -> bytes:
    client.do(protocol.GetImagery, run=run, layer=layer)
    received = client.first(protocol.ImageryReceived)
    assert (received.run, received.layer) == (run, layer)
    return received.data


def test_a_client_gets_the_pictures_of_a_terrain_and_is_told_where_there_are_none(tmp_path: Path) -> None:
    cases = [
        str(write_case_with_pictures(tmp_path / "with")),
        str(write_dam_break(tmp_path / "without", name="without")),
        str(write_case_with_pictures(tmp_path / "damaged", name="damaged")),
    ]
    (tmp_path / "damaged" / "ortho.png").write_bytes(b"<VRTDataset/>")
    with ServiceProcess(tmp_path / "data", cases=cases) as service, ServiceClient(service) as client:
        run = client.do(protocol.StartRun, case="with-pictures", duration=5.0)["run"]
        info = client.first(protocol.RunChanged, lambda event: event.run.run == run).run
        assert info.layers == ("imagery", "walls")

        imagery = fetch(client, run, "imagery")
        assert len(imagery) > protocol.limits.PART_BYTES
        assert Image.open(io.BytesIO(imagery)).format == "JPEG"
        picture = decode_imagery(imagery)
        assert picture.shape == (1200, 1200, 3)
        assert (np.abs(picture[:590].astype(int) - (254, 0, 0)) < 12).all()

        walls = decode_walls(fetch(client, run, "walls"), (CELLS, CELLS))
        expected = np.zeros((CELLS, CELLS), np.bool_)
        expected[-20:, -30:] = True
        assert np.array_equal(walls, expected)

        bare = client.do(protocol.StartRun, case="without", duration=5.0)["run"]
        refusal = client.ask(protocol.GetImagery, run=bare, layer="imagery")
        assert isinstance(refusal, protocol.Error)
        assert "has no imagery of its terrain; it has none" in refusal.message

        refusal = client.ask(protocol.StartRun, case="damaged", duration=5.0)
        assert isinstance(refusal, protocol.Error)
        assert "'ortho.png' does not begin like a TIFF, PNG or JPEG" in refusal.message
