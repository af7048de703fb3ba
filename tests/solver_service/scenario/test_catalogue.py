import subprocess
import sys
import zipfile
from pathlib import Path

import numpy as np
import pytest

from solver_service.errors import CaseError
from solver_service.scenario import case_summary, list_cases, load_case
from tests.solver_service.tiny_case import CASE, write_case


@pytest.fixture(autouse=True)
def _no_data_home(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("FEV_DATA_HOME", raising=False)


def test_the_embedded_case_is_a_hypothetical_dam_break_on_half_a_million_cells() -> None:
    case = load_case("jacksboro")

    assert case.hypothetical
    assert "ypothetical" in case.title
    assert 500_000 <= case.grid.cell_count <= 1_100_000
    assert case.grid.crs == "EPSG:32616"
    volume = case.initial_h.sum(dtype=np.float64) * case.grid.dx**2
    assert 20e6 < volume < 80e6
    assert 100 <= case.duration / case.output_interval <= 200
    assert case.model.blocked is None


def test_the_reservoir_of_the_embedded_case_is_one_pool_behind_one_dam() -> None:
    from scipy import ndimage

    case = load_case("jacksboro")

    pools, count = ndimage.label(case.initial_h > 0.0)
    assert count == 1
    level = (case.z_b + case.initial_h)[pools == 1] + case.grid.datum_offset
    np.testing.assert_allclose(level, 418.0, atol=1e-3)
    # It does not lean on the edge of the map.
    assert not pools[[0, -1]].any()
    assert not pools[:, [0, -1]].any()


def test_norris_lake_is_flat_and_in_the_south_east_of_the_embedded_case() -> None:
    case = load_case("jacksboro")

    elevation = case.z_b + case.grid.datum_offset
    rows, cols = np.nonzero(np.abs(elevation - 305.0) < 0.25)

    assert rows.size > 2000
    assert np.median(rows) < 0.5 * case.grid.nrows
    assert np.median(cols) > 0.5 * case.grid.ncols


def test_the_script_makes_the_embedded_terrain_again(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    repository = Path(__file__).parents[3]
    made = tmp_path / "terrain.npz"
    subprocess.run(
        [sys.executable, repository / "examples" / "make_jacksboro.py", made], check=True, timeout=120
    )

    with np.load(made) as new, np.load(repository / "solver_service/cases/jacksboro/terrain.npz") as kept:
        assert set(new) == set(kept)
        beds = [np.cumsum(np.cumsum(file["bed"], 0, np.int16), 1, np.int16) for file in (new, kept)]
    assert np.abs(beds[0].astype(int) - beds[1]).max() <= 1


def test_cases_of_the_data_home_have_names(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_case(tmp_path / "home" / "valley", CASE.replace('"tiny"', '"valley"'))
    folder = write_case(tmp_path / "other")
    with zipfile.ZipFile(tmp_path / "home" / "packed.fevcase", "w") as archive:
        for file in folder.iterdir():
            archive.write(file, file.name)
    monkeypatch.setenv("FEV_DATA_HOME", str(tmp_path / "home"))

    assert list_cases() == ["jacksboro", "malpasset", "valley", "packed"]
    assert load_case("valley").name == "valley"
    assert load_case("packed").grid.shape == (24, 40)


def test_a_case_is_found_by_folder_file_and_archive(tmp_path: Path) -> None:
    folder = write_case(tmp_path / "valley")

    assert load_case(folder).name == "tiny"
    assert load_case(str(folder / "case.toml")).name == "tiny"


def test_a_summary_says_what_a_case_is(tmp_path: Path) -> None:
    summary = case_summary(write_case(tmp_path / "valley"))

    assert (summary.name, summary.title, summary.hypothetical) == ("tiny", "A dam in a valley", True)
    assert (summary.nrows, summary.ncols, summary.dx) == (24, 40, 10.0)
    assert (summary.duration, summary.output_interval) == (20.0, 5.0)


def test_the_summary_of_malpasset_needs_no_data() -> None:
    summary = case_summary("malpasset")

    assert (summary.nrows, summary.ncols, summary.dx) == (613, 1150, 15.0)
    assert "GPL" in summary.licence


def test_summary_and_terrain_of_the_embedded_case_agree() -> None:
    summary, case = case_summary("jacksboro"), load_case("jacksboro")

    assert (summary.nrows, summary.ncols, summary.dx) == (case.grid.nrows, case.grid.ncols, case.grid.dx)


@pytest.mark.parametrize(
    "name", ["atlantis", "", "no/such/folder", "../jacksboro", "a\0b", "x" * 200, "x" * 5000]
)
def test_an_unknown_case_lists_the_known_ones(name: str) -> None:
    with pytest.raises(CaseError, match="jacksboro, malpasset, or the path of a case"):
        load_case(name)


@pytest.mark.parametrize("cell_size", [0.0, -5.0, float("nan"), 1e9])
def test_an_absurd_cell_size_is_refused(cell_size: float) -> None:
    with pytest.raises(CaseError, match="cell size is"):
        load_case("jacksboro", cell_size)
