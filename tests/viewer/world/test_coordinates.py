import numpy as np
import pytest

from protocol import GridGeometry
from viewer.world import WorldFrame

GRID = GridGeometry(nrows=100, ncols=200, dx=10.0, x0=500.0, y0=7000.0)


def test_the_centre_of_the_grid_is_the_origin() -> None:
    assert WorldFrame.of_grid(GRID).to_world(1500.0, 7500.0, 0.0) == (0.0, 0.0, 0.0)


def test_east_is_x_up_is_y_and_north_is_minus_z() -> None:
    frame = WorldFrame.of_grid(GRID)

    assert frame.to_world(1510.0, 7500.0, 0.0) == (10.0, 0.0, 0.0)
    assert frame.to_world(1500.0, 7510.0, 0.0) == (0.0, 0.0, -10.0)
    assert frame.to_world(1500.0, 7500.0, 10.0) == (0.0, 10.0, 0.0)


def test_the_way_back_leads_home_under_exaggeration() -> None:
    frame = WorldFrame.of_grid(GRID, z_ref=40.0).exaggerated(2.5)

    assert frame.from_world(frame.to_world(733.0, 7211.0, 61.5)) == pytest.approx((733.0, 7211.0, 61.5))


def test_exaggeration_keeps_the_reference_height() -> None:
    frame = WorldFrame.of_grid(GRID, z_ref=40.0).exaggerated(3.0)

    assert frame.height(40.0) == 40.0
    assert frame.height(41.0) == 43.0


def test_many_points_go_the_same_way_as_one() -> None:
    frame = WorldFrame.of_grid(GRID, z_ref=5.0).exaggerated(2.0)
    places = np.array([[733.0, 7211.0, 61.5], [1500.0, 7500.0, 0.0]])

    assert frame.to_world_array(places).tolist() == [list(frame.to_world(*place)) for place in places]
