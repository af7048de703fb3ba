from pathlib import Path

import numpy as np
import pytest

from solver_service.errors import CaseError
from solver_service.scenario import load_case
from tests.solver_service.dry_case import DRY
from tests.solver_service.tiny_case import COLS, ROWS, valley, write_case

LAND = DRY.replace("manning_n = 0.03", 'classes = "land.npz"\ntable = "land.csv"')
TABLE = "class,name,manning_n\n41,forest,0.1\n21,town,0.05\n-3,water,0.025\n"


def written(folder: Path, land: np.ndarray, table: str = TABLE, bed: np.ndarray | None = None) -> Path:
    write_case(folder, LAND, bed)
    np.savez(folder / "land.npz", classes=land)
    (folder / "land.csv").write_text(table)
    return folder


def test_each_cell_takes_the_value_of_its_class(tmp_path: Path, rng: np.random.Generator) -> None:
    land = rng.choice([41, 21, -3], size=(ROWS, COLS))

    n = load_case(written(tmp_path, land)).model.manning_n

    expected = np.select([land == 41, land == 21], [0.1, 0.05], 0.025)
    np.testing.assert_array_equal(n, expected.astype(np.float32))


def test_a_coarse_raster_of_classes_is_spread_over_finer_cells(tmp_path: Path) -> None:
    land = np.full((ROWS // 4, COLS // 4), 21)
    land[0, 0] = 41
    written(tmp_path, land)
    np.savez(tmp_path / "land.npz", classes=land, dx=40.0, x0=1000.0, y0=2000.0)

    n = load_case(tmp_path).model.manning_n

    assert (n[:4, :4] == np.float32(0.1)).all()
    assert (n == np.float32(0.1)).sum() == 16


def test_walls_need_no_class(tmp_path: Path) -> None:
    land = np.full((ROWS, COLS), 21.0)
    land[4, 5] = np.nan
    bed = valley()
    bed[4, 5] = np.nan

    n = load_case(written(tmp_path, land, bed=bed)).model.manning_n

    assert (n[land == 21] == np.float32(0.05)).all()


@pytest.mark.parametrize(
    ("value", "table", "message"),
    [
        (
            99,
            TABLE,
            r"classes is 'land.npz'; cell \(row 2, column 3\) holds the class 99; a class of",
        ),
        (np.nan, TABLE, r"cell \(row 2, column 3\) holds no class"),
        (21.5, TABLE, r"holds the class 21.5"),
        (
            21,
            "class,n\n21,0.1\n",
            "land.csv: line 1 names no column 'manning_n'; class, manning_n",
        ),
        (21, "code,manning_n\n21,0.1\n", "land.csv: line 1 names no column 'class'"),
        (21, "class,manning_n\n", "land.csv: has 0 classes"),
        (
            21,
            "class,manning_n\n21,0.1\n21,0.2\n",
            "land.csv: line 3 has the class 21; a whole number",
        ),
        (21, "class,manning_n\n21.5,0.1\n", "line 2 has the class 21.5"),
        (21, "class,manning_n\n21,35\n", "line 2 has 35 in column 'manning_n'; a number from 0 to 1 is"),
        (21, "class,manning_n\n21,\n", "line 2 has no 'manning_n'; a number is needed in every line"),
    ],
)
def test_bad_classes_are_told(tmp_path: Path, value: float, table: str, message: str) -> None:
    land = np.full((ROWS, COLS), 21.0)
    land[2, 3] = value

    with pytest.raises(CaseError, match=message):
        load_case(written(tmp_path, land, table))
