import math

import numpy as np
import pytest

from viewer.world import Camera, overview
from viewer.world.camera import ELEVATION_MAX

CAMERA = Camera((10.0, 20.0, -30.0), 100.0, math.radians(50.0), math.radians(30.0))


def project(camera: Camera, point: np.ndarray, aspect: float = 1.5) -> np.ndarray:
    clip = camera.projection(aspect, 1.0, 1000.0) @ camera.view_matrix() @ np.append(point, 1.0)
    return clip[:3] / clip[3]


def test_the_target_is_in_the_middle_of_the_picture() -> None:
    assert project(CAMERA, np.array(CAMERA.target))[:2] == pytest.approx((0.0, 0.0), abs=1e-12)


def test_the_eye_stands_at_its_distance_and_height() -> None:
    offset = CAMERA.eye - np.array(CAMERA.target)

    assert np.linalg.norm(offset) == pytest.approx(100.0)
    assert offset[1] == pytest.approx(50.0)


def test_azimuth_0_looks_north_and_90_looks_east() -> None:
    north = Camera((0.0, 0.0, 0.0), 1.0, 0.0, 0.0).forward
    east = Camera((0.0, 0.0, 0.0), 1.0, math.pi / 2, 0.0).forward

    assert north == pytest.approx((0.0, 0.0, -1.0))
    assert east == pytest.approx((1.0, 0.0, 0.0), abs=1e-12)


def test_straight_down_north_is_up_and_east_is_right() -> None:
    camera = Camera((0.0, 0.0, 0.0), 100.0, 0.0, math.pi / 2)

    assert project(camera, np.array([0.0, 0.0, -10.0]))[1] > 0.05
    assert project(camera, np.array([10.0, 0.0, 0.0]))[0] > 0.05


def test_near_and_far_planes_are_the_ends_of_depth() -> None:
    near, far = CAMERA.eye + CAMERA.forward, CAMERA.eye + 1000.0 * CAMERA.forward

    assert project(CAMERA, near)[2] == pytest.approx(-1.0)
    assert project(CAMERA, far)[2] == pytest.approx(1.0)


def test_a_ray_goes_through_the_point_that_is_drawn_there() -> None:
    point = CAMERA.eye + 70.0 * CAMERA.ray(0.4, -0.7, 1.5)

    assert project(CAMERA, point)[:2] == pytest.approx((0.4, -0.7))


def test_the_view_axes_are_orthonormal() -> None:
    axes = np.stack([CAMERA.right, CAMERA.up, CAMERA.forward])

    assert axes @ axes.T == pytest.approx(np.eye(3))
    assert CAMERA.up[1] > 0.0


def test_orbiting_stops_at_the_zenith() -> None:
    assert CAMERA.orbited(0.0, 10.0).elevation == ELEVATION_MAX


def test_panning_moves_eye_and_target_alike() -> None:
    moved = CAMERA.panned(3.0, 4.0)

    assert moved.eye - CAMERA.eye == pytest.approx(np.array(moved.target) - np.array(CAMERA.target))
    assert math.dist(moved.target, CAMERA.target) == pytest.approx(5.0)
    assert moved.target[1] == CAMERA.target[1]


def test_zoom_keeps_its_limits() -> None:
    assert CAMERA.zoomed(1e-9).distance == 2.0
    assert CAMERA.zoomed(1e9).distance == 1e6


def test_a_camera_under_a_hill_is_lifted_above_it() -> None:
    def ground(x: object, z: object) -> object:
        return 200.0 * np.exp(-(((np.asarray(x) - 0.0) / 80.0) ** 2))

    buried = Camera((100.0, 40.0, 0.0), 120.0, math.pi / 2, math.radians(5.0))
    assert buried.eye[1] < ground(buried.eye[0], buried.eye[2])

    free = buried.kept_above(ground, 5.0)

    assert free.eye[1] >= ground(free.eye[0], free.eye[2]) + 5.0
    assert free.target == buried.target


def test_a_camera_in_the_open_is_left_alone() -> None:
    assert CAMERA.kept_above(lambda x, z: 0.0 * np.asarray(x), 5.0) is CAMERA


def test_a_target_deep_under_ground_is_lifted_too() -> None:
    camera = Camera((0.0, -500.0, 0.0), 10.0, 0.0, 0.3).kept_above(lambda x, z: 0.0 * np.asarray(x), 5.0)

    assert camera.eye[1] >= 5.0


@pytest.mark.parametrize("azimuth", [0.0, 40.0, 200.0])
@pytest.mark.parametrize("aspect", [0.8, 16.0 / 9.0])
def test_the_overview_shows_all_corners_and_wastes_little(azimuth: float, aspect: float) -> None:
    camera = overview(3000.0, 2000.0, 50.0, azimuth=math.radians(azimuth), aspect=aspect)
    matrix = camera.projection(aspect, 1.0, 1e6) @ camera.view_matrix()
    corners = np.array([[x, 50.0, z, 1.0] for x in (-1500.0, 1500.0) for z in (-1000.0, 1000.0)])
    clip = corners @ matrix.T
    reach = np.abs(clip[:, :2] / clip[:, 3:]).max()

    assert 0.85 < reach < 1.0


def test_a_point_is_seen_where_the_matrices_put_it_and_not_behind_the_eye() -> None:
    camera = Camera((10.0, 5.0, -20.0), 300.0, 0.7, 0.5)
    point = (60.0, 12.0, 40.0)
    clip = camera.projection(1.6, 1.0, 1e4) @ camera.view_matrix() @ np.array([*point, 1.0])

    assert camera.seen_at(point, 1.6) == pytest.approx(tuple(clip[:2] / clip[3]))
    assert camera.seen_at(camera.target, 1.6) == pytest.approx((0.0, 0.0))
    assert camera.seen_at(tuple(2.0 * camera.eye - np.array(camera.target)), 1.6) is None
