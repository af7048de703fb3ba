import gzip
import os
from pathlib import Path

import numpy as np
import pytest

from solver_service.errors import TerrainError
from solver_service.terrain.read_selafin import read_mesh, read_selafin
from tests.solver_service.selafin_file import plane, selafin_bytes, write_selafin


def test_a_plane_is_reproduced_at_every_cell_centre(tmp_path: Path) -> None:
    raster = read_selafin(write_selafin(tmp_path / "mesh.slf"), 4.0)

    x = raster.x0 + (np.arange(raster.shape[1]) + 0.5) * 4.0
    y = raster.y0 + (np.arange(raster.shape[0]) + 0.5) * 4.0
    assert raster.bounds == (0.0, 0.0, 100.0, 60.0)
    np.testing.assert_allclose(raster.values, plane(*np.meshgrid(x, y)), atol=1e-5)


def test_cells_outside_the_mesh_have_no_data(tmp_path: Path) -> None:
    raster = read_selafin(write_selafin(tmp_path / "mesh.slf"), 10.0, (-20.0, 0.0, 120.0, 60.0))

    assert raster.shape == (6, 14)
    assert raster.void[:, :2].all()
    assert raster.void[:, -2:].all()
    assert not raster.void[:, 2:-2].any()


def test_a_zipped_mesh_with_a_stray_byte_is_read(tmp_path: Path) -> None:
    (tmp_path / "mesh.slf.gz").write_bytes(gzip.compress(selafin_bytes(name=b"FOND") + b"\n"))

    assert read_mesh(tmp_path / "mesh.slf.gz").triangles.shape == (48, 3)


def test_the_malpasset_mesh_gives_the_raster_made_from_it_bit_for_bit() -> None:
    folder = Path(os.environ.get("FEV_DATA_HOME", "")) / "malpasset"
    if not (folder / "geo_malpasset-large.slf.gz").is_file():
        pytest.skip("the Malpasset mesh of FEV_DATA_HOME is not there")
    kept = np.load(folder / "malpasset_15m.npz")

    raster = read_selafin(folder / "geo_malpasset-large.slf.gz", 15.0, (530.0, -2350.0, 17780.0, 6845.0))

    inside = kept["inside"][::-1].astype(bool)
    np.testing.assert_array_equal(~raster.void, inside)
    np.testing.assert_array_equal(raster.values[inside], kept["bed"][::-1][inside])


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", "ends early"),
        (b"\0\0\0\x50 cut", "no closing length|ends early"),
        (selafin_bytes(name=b"WATER DEPTH"), "VELOCITY U, WATER DEPTH; one named BOTTOM or FOND"),
        (selafin_bytes(corners=4), "4 corners; triangles are allowed"),
        (selafin_bytes()[:-300], "no closing length"),
        (os.urandom(500), "SELAFIN"),
    ],
    ids=["empty", "cut", "no bed", "quadrangles", "torn", "noise"],
)
def test_what_is_no_mesh_is_refused(tmp_path: Path, data: bytes, message: str) -> None:
    (tmp_path / "mesh.slf").write_bytes(data)

    with pytest.raises(TerrainError, match=message):
        read_selafin(tmp_path / "mesh.slf", 4.0)


def test_triangles_that_name_missing_nodes_are_refused(tmp_path: Path) -> None:
    good = selafin_bytes()
    wrong = good.replace(
        (1).to_bytes(4, "big") + (2).to_bytes(4, "big") + (9).to_bytes(4, "big"), b"\0\0\x7f\0" * 3
    )
    (tmp_path / "mesh.slf").write_bytes(wrong)

    with pytest.raises(TerrainError, match="nodes outside 1 to 35"):
        read_selafin(tmp_path / "mesh.slf", 4.0)


def test_a_mesh_needs_a_cell_size(tmp_path: Path) -> None:
    with pytest.raises(TerrainError, match=r"\[terrain\] cell_size in m is needed"):
        read_selafin(write_selafin(tmp_path / "mesh.slf"), None)
