from pathlib import Path

import numpy as np
import pytest
from pyproj import CRS

from solver_service.errors import TerrainError
from solver_service.terrain.read_ascii_grid import read_ascii_grid

HEADER = "NCOLS 3\nNROWS 2\nXLLCORNER 500\nYLLCORNER 800\nCELLSIZE 10\nNODATA_VALUE -1\n"


def written(folder: Path, text: str) -> Path:
    path = folder / "bed.asc"
    path.write_text(text)
    return path


def test_rows_are_turned_and_words_for_no_number_are_holes(tmp_path: Path) -> None:
    raster = read_ascii_grid(written(tmp_path, HEADER + "5 6 7\n1 -1 nan\n"))

    np.testing.assert_array_equal(raster.values, [[1.0, np.nan, np.nan], [5.0, 6.0, 7.0]])
    assert raster.bounds == (500.0, 800.0, 530.0, 820.0)
    assert raster.crs is None


def test_rows_may_be_wrapped_and_the_corner_given_as_a_centre(tmp_path: Path) -> None:
    text = "ncols 3\nnrows 2\nxllcenter 505\nyllcenter 805\ncellsize 10\n5 6\n7 1\n-9999 3\n"

    raster = read_ascii_grid(written(tmp_path, text))

    np.testing.assert_array_equal(raster.values, [[1.0, np.nan, 3.0], [5.0, 6.0, 7.0]])
    assert (raster.x0, raster.y0) == (500.0, 800.0)


def test_the_system_stands_in_the_prj_beside(tmp_path: Path) -> None:
    path = written(tmp_path, HEADER + "5 6 7\n1 2 3\n")
    (tmp_path / "bed.prj").write_text(CRS.from_epsg(32632).to_wkt())

    assert CRS.from_user_input(read_ascii_grid(path).crs).to_epsg() == 32632


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "no 'ncols'"),
        ("nothing here", "no 'ncols'"),
        (HEADER + "1 2 3\n", "ends after 3 of 2 x 3 numbers"),
        (HEADER + "1 2 3 4 5 6 7\n", "more than its 2 x 3 numbers"),
        (HEADER + "1 2 3 4 five 6\n", "could not convert"),
        (HEADER.replace("10", "-10") + "1 2 3 4 5 6\n", "no cellsize above 0"),
        (HEADER.replace("CELLSIZE 10", "CELLSIZE nan") + "1 2 3 4 5 6\n", "no cellsize above 0"),
        (HEADER.replace("NCOLS 3", "NCOLS 1e300"), "1 to"),
        (HEADER.replace("NCOLS 3", "NCOLS inf"), "cannot convert"),
    ],
)
def test_what_is_no_grid_is_refused(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(TerrainError, match=f"'bed.asc'.*{message}"):
        read_ascii_grid(written(tmp_path, text))
