import numpy as np
import pytest

from protocol import GridGeometry
from viewer.world import Heightfield, probe

GRID = GridGeometry(nrows=3, ncols=4, dx=10.0, x0=100.0, y0=200.0, datum_offset=50.0)
Z_B = np.arange(12, dtype=np.float32).reshape(3, 4)


@pytest.fixture
def field() -> Heightfield:
    return Heightfield(GRID, Z_B)


def test_a_wet_cell_tells_ground_depth_and_level_above_the_datum(field: Heightfield) -> None:
    h = np.zeros((3, 4), dtype=np.float32)
    h[1, 2] = 1.5
    reading = probe(field, 127.0, 214.0, h)

    assert reading is not None
    assert (reading.row, reading.col) == (1, 2)
    assert (reading.ground, reading.depth, reading.level) == (56.0, 1.5, 57.5)


def test_a_dry_cell_has_no_level(field: Heightfield) -> None:
    reading = probe(field, 127.0, 214.0, np.zeros((3, 4), dtype=np.float32))

    assert reading is not None
    assert (reading.depth, reading.level) == (0.0, None)


def test_between_frames_the_depth_is_blended_as_in_the_picture(field: Heightfield) -> None:
    first, second = np.full((3, 4), 1.0, dtype=np.float32), np.full((3, 4), 3.0, dtype=np.float32)
    reading = probe(field, 105.0, 205.0, first, second, 0.25)

    assert reading is not None
    assert reading.depth == pytest.approx(1.5)


@pytest.mark.parametrize(("x", "y"), [(99.9, 205.0), (140.1, 205.0), (105.0, 199.9), (105.0, 230.1)])
def test_outside_the_map_there_is_no_reading(field: Heightfield, x: float, y: float) -> None:
    assert probe(field, x, y) is None
