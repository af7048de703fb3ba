import math

import numpy as np
import pytest

from protocol import GridGeometry
from viewer.world import Heightfield, measure

FLAT = Heightfield(GridGeometry(50, 80, 10.0, 500_000.0, 4_000_000.0), np.full((50, 80), 7.0, np.float32))
X0, Y0 = 500_000.0, 4_000_000.0


def slope() -> Heightfield:
    """Rises by 3 m for every 4 m to the east."""
    east = (np.arange(80) + 0.5) * 10.0
    return Heightfield(FLAT.grid, np.broadcast_to(0.75 * east, (50, 80)).astype(np.float32).copy())


def test_on_flat_ground_both_lengths_are_the_same() -> None:
    made = measure([(X0 + 100.0, Y0 + 100.0), (X0 + 400.0, Y0 + 100.0), (X0 + 400.0, Y0 + 300.0)], FLAT)

    assert made.length == made.ground_length == 500.0
    assert made.rise == 0.0
    assert made.area == pytest.approx(30_000.0, rel=1e-12)
    assert made.perimeter == pytest.approx(500.0 + math.hypot(300.0, 200.0))


def test_up_a_slope_the_ground_is_longer_than_the_map() -> None:
    made = measure([(X0 + 100.0, Y0 + 100.0), (X0 + 500.0, Y0 + 100.0)], slope())

    assert made.length == 400.0
    assert made.ground_length == pytest.approx(500.0)
    assert made.rise == pytest.approx(300.0)
    assert made.area == 0.0


def test_the_area_does_not_depend_on_direction_or_first_point() -> None:
    ring = [(X0 + 0.0, Y0 + 0.0), (X0 + 70.0, Y0 + 10.0), (X0 + 60.0, Y0 + 80.0), (X0 + 5.0, Y0 + 60.0)]
    areas = {
        round(measure(turned, FLAT).area, 6)
        for k in range(4)
        for turned in (ring[k:] + ring[:k], (ring[k:] + ring[:k])[::-1])
    }

    assert len(areas) == 1
    assert areas.pop() == pytest.approx(4_100.0)  # by hand


def test_a_single_point_measures_nothing() -> None:
    made = measure([(X0 + 10.0, Y0 + 10.0)], FLAT)

    assert (made.length, made.area, made.perimeter) == (0.0, 0.0, 0.0)
