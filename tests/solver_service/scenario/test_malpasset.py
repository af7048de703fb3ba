import gc
import hashlib
import http.server
import os
import threading
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from solver_service.errors import CaseError
from solver_service.scenario import load_case, malpasset
from tests.solver_service.selafin_file import plane, selafin_bytes

MESH = selafin_bytes(width=17_000.0, height=6_000.0)
SHA256 = hashlib.sha256(MESH).hexdigest()


class Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, format: str, *args: object) -> None:
        pass


@pytest.fixture
def address(tmp_path: Path) -> Iterator[str]:
    """A server with a mesh, on this machine."""
    folder = tmp_path / "public"
    folder.mkdir()
    (folder / "mesh.slf").write_bytes(MESH)
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), partial(Quiet, directory=str(folder)))
    thread = threading.Thread(target=server.serve_forever)
    thread.start()
    yield f"http://127.0.0.1:{server.server_port}"
    server.shutdown()
    server.server_close()
    thread.join()


def test_a_mesh_is_downloaded_checked_and_laid_on_the_cells(address: str, tmp_path: Path, caplog) -> None:
    folder = malpasset.download(tmp_path / "cache", f"{address}/mesh.slf", SHA256)

    assert [path.name for path in folder.iterdir()] == [malpasset.FILE]
    assert "licence: GNU GPL 3" in caplog.text
    with np.load(folder / malpasset.FILE) as data:
        assert data["bed"].shape == (613, 1150)
        # Row 0 is the northern edge; the cell at column 400, row 300 from the south lies inside the mesh.
        x, y = 530.0 + 400.5 * 15.0, -2350.0 + 300.5 * 15.0
        assert data["bed"][612 - 300, 400] == pytest.approx(float(plane(x, y)), abs=1e-2)
        assert (data["bed"][~data["inside"]] == 101.0).all()


# The HTTP library leaves the socket of a refused answer to the garbage collector.
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
@pytest.mark.parametrize(("name", "sha256"), [("mesh.slf", "0" * 64), ("none.slf", SHA256)])
def test_a_failed_download_leaves_nothing(address: str, tmp_path: Path, name: str, sha256: str) -> None:
    with pytest.raises(CaseError, match=r"neither in FEV_DATA_HOME nor in .* download .* failed") as caught:
        malpasset.download(tmp_path / "cache", f"{address}/{name}", sha256)

    gc.collect()
    assert "\n" not in str(caught.value)
    assert list((tmp_path / "cache").iterdir()) == []


def test_the_data_home_comes_before_the_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("home/malpasset", "cache"):
        (tmp_path / name).mkdir(parents=True)
        (tmp_path / name / malpasset.FILE).touch()
    monkeypatch.setattr(malpasset, "cache_folder", lambda: tmp_path / "cache")

    monkeypatch.setenv("FEV_DATA_HOME", str(tmp_path / "home"))
    assert malpasset.local_folder() == tmp_path / "home" / "malpasset"
    monkeypatch.setenv("FEV_DATA_HOME", str(tmp_path))
    assert malpasset.data_folder() == tmp_path / "cache"


@pytest.fixture
def kept() -> Path:
    folder = Path(os.environ.get("FEV_DATA_HOME", "")) / "malpasset"
    if not (folder / malpasset.FILE).is_file():
        pytest.skip("the Malpasset terrain of FEV_DATA_HOME is not there")
    return folder


def test_the_reservoir_and_the_sea_stand_as_in_the_reference_data(kept: Path) -> None:
    case = load_case("malpasset")

    with np.load(kept / malpasset.FILE) as data:
        np.testing.assert_array_equal(case.initial_h, data["depth0"][::-1])
        np.testing.assert_array_equal(case.model.blocked, ~data["inside"][::-1].astype(bool))
    assert len(case.gauges) == 29
    assert [gauge.id for gauge in case.gauges][::8] == ["P1", "P9", "P17", "S13"]


def test_the_mesh_itself_gives_the_same_case(kept: Path, tmp_path: Path) -> None:
    mesh = kept / "geo_malpasset-large.slf.gz"
    if not mesh.is_file():
        pytest.skip("the Malpasset mesh of FEV_DATA_HOME is not there")
    malpasset.convert(mesh, tmp_path / malpasset.FILE)

    with np.load(tmp_path / malpasset.FILE) as made, np.load(kept / malpasset.FILE) as data:
        np.testing.assert_array_equal(made["bed"], data["bed"])
