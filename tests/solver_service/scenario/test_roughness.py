from pathlib import Path

import numpy as np
import pytest

from solver_service.errors import ServiceError
from solver_service.scenario import load_case
from tests.solver_service.tiny_case import CASE, COLS, ROWS, write_case


def changed(old: str, new: str) -> str:
    assert old in CASE
    return CASE.replace(old, new)


def test_roughness_is_one_number_zones_or_a_raster(tmp_path: Path) -> None:
    west = "[[1000, 2000], [1100, 2000], [1100, 2240], [1000, 2240]]"
    zone = f"\n[[roughness.zone]]\nmanning_n = 0.1\npolygon = {west}\n"
    assert load_case(write_case(tmp_path / "a")).model.manning_n == 0.03
    zoned = load_case(write_case(tmp_path / "b", CASE + zone)).model.manning_n
    assert (zoned[:, :10] == np.float32(0.1)).all()
    assert (zoned[:, 10:] == np.float32(0.03)).all()

    write_case(tmp_path / "c", changed("manning_n = 0.03", 'raster = "n.npz"'))
    np.savez(tmp_path / "c" / "n.npz", manning_n=np.full((ROWS, COLS), 0.05))
    assert (load_case(tmp_path / "c").model.manning_n == np.float32(0.05)).all()


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ('manning_n = 0.03\nraster = "n.npz"', "has manning_n and raster; one of manning_n, raster, classes"),
        ('manning_n = 0.03\ntable = "n.csv"', "table is 'n.csv'; it means something only beside 'classes'"),
        ('manning_n = 0.03\nkey = "n"', "key is 'n'; it means something only beside 'raster'"),
        ('classes = "n.npz"', "table is missing"),
    ],
)
def test_one_way_to_say_it_is_allowed(tmp_path: Path, keys: str, message: str) -> None:
    with pytest.raises(ServiceError, match=message):
        load_case(write_case(tmp_path, changed("manning_n = 0.03", keys)))


def test_a_value_that_looks_like_another_law_is_told(tmp_path: Path) -> None:
    case = load_case(write_case(tmp_path, changed("manning_n = 0.03", "manning_n = 0.8")))

    assert case.warnings == ("[roughness] reaches n = 0.8; is it really Manning's n?",)


def test_walls_need_no_roughness(tmp_path: Path) -> None:
    values = np.full((ROWS, COLS), 0.05)
    values[2, 3] = np.nan
    bed = np.full((ROWS, COLS), 300.0)
    write_case(tmp_path, changed("manning_n = 0.03", 'raster = "n.npz"'), bed)
    np.savez(tmp_path / "n.npz", manning_n=values)
    with pytest.raises(ServiceError, match=r"cell \(row 2, column 3\) holds nan"):
        load_case(tmp_path)

    bed[2, 3] = np.nan
    write_case(tmp_path, changed("manning_n = 0.03", 'raster = "n.npz"'), bed)
    assert load_case(tmp_path).model.manning_n[2, 4] == np.float32(0.05)
