import numpy as np
import pytest

import protocol
from viewer.app.flood_front import find_front, place_levee

GRID = protocol.GridGeometry(80, 120, 10.0)


def channel() -> np.ndarray:
    """A channel along row 40 with banks 30 m high that come close at column 70 [m]."""
    row, col = np.mgrid[0:80, 0:120]
    half_width = 10 + np.abs(col - 70) // 4
    z = np.where(np.abs(row - 40) > half_width, 30.0, 0.0) + 0.01 * (120 - col)
    return z.astype(np.float32)


def water(until_col: int) -> np.ndarray:
    z = channel()
    col = np.arange(120)[None, :]
    return np.where((z < 10.0) & (col < until_col), 3.0, 0.0).astype(np.float32)


def test_the_front_is_where_new_ground_is_wet() -> None:
    front = find_front(water(30), water(36))

    assert front is not None
    assert 30 <= front.col < 36
    assert abs(front.row - 40) < 20


def test_water_that_only_deepens_has_no_front() -> None:
    assert find_front(water(30), 2.0 * water(30)) is None


def test_the_levee_closes_the_narrows_ahead_of_the_front() -> None:
    levee = place_levee(GRID, channel(), [(40.0, col) for col in range(40, 100, 5)], water(30), water(110))

    assert levee is not None
    ends = [GRID.to_cell(*end) for end in (levee.start, levee.end)]
    for row, col in ends:
        assert channel()[round(row), round(col)] > 20.0
    assert min(end[0] for end in ends) < 40 < max(end[0] for end in ends)
    assert 35 < ends[0][1] < 85
    assert levee.height > 3.0


def test_a_levee_touches_no_water_that_is_there_already() -> None:
    levee = place_levee(GRID, channel(), [(40.0, 20.0)], water(30), water(110))

    assert levee is None


def test_on_an_open_plain_no_levee_holds() -> None:
    flat = np.zeros((80, 120), dtype=np.float32)
    now, later = flat.copy(), flat.copy()
    now[:, :20], later[:, :100] = 1.0, 1.0

    assert place_levee(GRID, flat, [(40.0, 50.0)], now, later) is None


def test_a_levee_knows_its_middle_and_length() -> None:
    levee = place_levee(GRID, channel(), [(40.0, 70.0)], water(30), water(110))

    assert levee is not None
    assert levee.length == pytest.approx(np.hypot(*(np.array(levee.start) - np.array(levee.end))))
    assert levee.middle[0] == pytest.approx((levee.start[0] + levee.end[0]) / 2)
