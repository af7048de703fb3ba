import math

import numpy as np
import pytest

from protocol import GridGeometry
from viewer.world import Camera, Heightfield, flood_extent, ground_in_view, relief_map
from viewer.world.reference_map import MAP_PIXELS


def ground(nrows: int, ncols: int) -> Heightfield:
    rows, cols = np.mgrid[0:nrows, 0:ncols]
    grid = GridGeometry(nrows, ncols, 10.0, 1000.0, 2000.0)
    return Heightfield(grid, (30.0 * np.sin(rows / 9.0) * np.cos(cols / 7.0)).astype(np.float32))


@pytest.mark.parametrize("shape", [(2, 3), (100, 40), (257, 256), (700, 1301)])
def test_relief_and_flood_have_the_same_shape_and_at_most_so_many_pixels(shape: tuple[int, int]) -> None:
    relief = relief_map(ground(*shape))
    flood = flood_extent(np.zeros(shape, np.float32), 0.01)

    assert relief.shape[:2] == flood.shape
    assert max(flood.shape) <= MAP_PIXELS
    assert not flood.any()


def test_the_map_has_north_on_top() -> None:
    h = np.zeros((40, 40), np.float32)
    h[39, 0] = 1.0  # north-west

    assert flood_extent(h, 0.01)[0, 0]
    assert flood_extent(h, 0.01).sum() == 1


def test_a_river_of_one_cell_is_not_lost_on_a_coarse_map() -> None:
    h = np.zeros((1000, 1000), np.float32)
    h[:, 501] = 0.5
    flood = flood_extent(h, 0.01)

    assert flood.any(axis=1).all()
    assert flood.sum(axis=1).max() == 1


def test_slopes_toward_the_light_are_brighter_than_those_away_from_it() -> None:
    col = np.arange(60, dtype=np.float32)
    ridge = np.tile(30.0 - np.abs(col - 30.0), (60, 1)).astype(np.float32)
    relief = relief_map(Heightfield(GridGeometry(60, 60, 10.0, 0.0, 0.0), ridge)).astype(int).sum(axis=2)

    assert relief[30, 15] > 1.2 * relief[30, 45]


def test_straight_down_the_ground_in_view_is_the_picture_itself() -> None:
    field = ground(100, 100)
    camera = Camera((0.0, 0.0, 0.0), 1000.0, 0.0, math.pi / 2.0, math.radians(90.0))
    corners = ground_in_view(camera, 2.0, field.frame)

    expected = [(-500.0, 1500.0), (3500.0, 1500.0), (3500.0, 3500.0), (-500.0, 3500.0)]
    np.testing.assert_allclose(corners, expected, atol=1e-6)


def test_a_view_over_the_horizon_ends_at_a_finite_distance_ahead() -> None:
    field = ground(100, 100)
    camera = Camera((0.0, 0.0, 0.0), 1000.0, math.pi / 2.0, math.radians(5.0))
    corners = np.array(ground_in_view(camera, 1.6, field.frame))

    assert np.isfinite(corners).all()
    assert corners[2:, 0].min() > corners[:2, 0].max()  # looking east: the far corners lie in the east
