import math
from itertools import pairwise

import numpy as np
import pytest

from viewer.world import Camera, Flight, Move, OrbitMotion

START = Camera((0.0, 0.0, 0.0), 1000.0, 0.3, 0.6)


def run(motion: OrbitMotion, camera: Camera, steps: int, dt: float) -> Camera:
    for _ in range(steps):
        camera = motion.advance(camera, dt)
    return camera


@pytest.mark.parametrize("move", list(Move))
def test_a_held_key_moves_as_far_at_any_picture_rate(move: Move) -> None:
    slow, fast = OrbitMotion(), OrbitMotion()
    slow.hold(move)
    fast.hold(move)
    a = run(slow, START, 4, 0.125)
    b = run(fast, START, 64, 0.125 / 16)

    assert a != START
    assert b.target == pytest.approx(a.target)
    assert (b.distance, b.azimuth, b.elevation) == pytest.approx((a.distance, a.azimuth, a.elevation))


def test_a_released_key_lets_the_camera_come_to_rest() -> None:
    motion = OrbitMotion()
    motion.hold(Move.ORBIT_RIGHT)
    camera = run(motion, START, 10, 0.05)
    motion.release(Move.ORBIT_RIGHT)
    coasting = motion.advance(camera, 0.02)
    resting = run(motion, coasting, 200, 0.02)

    assert coasting.azimuth > camera.azimuth
    assert not motion.is_moving
    assert motion.advance(resting, 0.5).azimuth == pytest.approx(resting.azimuth, abs=1e-6)


def test_opposite_keys_cancel() -> None:
    motion = OrbitMotion()
    motion.hold(Move.PAN_LEFT)
    motion.hold(Move.PAN_RIGHT)

    assert run(motion, START, 10, 0.05).target == pytest.approx(START.target)


def test_a_drag_turns_by_exactly_what_the_mouse_moved() -> None:
    motion = OrbitMotion()
    motion.begin_drag()
    camera = START
    for _ in range(10):
        motion.drag_orbit(0.01, 0.0)
        camera = motion.advance(camera, 0.016)

    assert camera.azimuth - START.azimuth == pytest.approx(0.1 * math.pi)


def test_a_drag_let_go_coasts_on_the_same_way() -> None:
    motion = OrbitMotion()
    motion.begin_drag()
    camera = START
    for _ in range(10):
        motion.drag_orbit(0.01, 0.0)
        camera = motion.advance(camera, 0.016)
    motion.end_drag()
    after = run(motion, camera, 100, 0.016)

    assert 0.01 < after.azimuth - camera.azimuth < 0.5
    assert not motion.is_moving


def test_a_drag_held_still_before_it_is_let_go_does_not_coast() -> None:
    motion = OrbitMotion()
    motion.begin_drag()
    motion.drag_orbit(0.1, 0.0)
    camera = run(motion, START, 60, 0.016)
    motion.end_drag()

    assert run(motion, camera, 50, 0.016).azimuth == pytest.approx(camera.azimuth, abs=1e-3)


def test_dragging_the_ground_keeps_it_under_the_mouse() -> None:
    motion = OrbitMotion()
    top = Camera((0.0, 0.0, 0.0), 1000.0, 0.0, math.pi / 2)
    motion.begin_drag()
    motion.drag_pan(0.25, 0.0, top)
    moved = motion.advance(top, 0.016)

    assert moved.target[0] == pytest.approx(-0.25 * 2.0 * math.tan(top.fov_y / 2) * 1000.0)


def test_a_wheel_step_zooms_by_a_fixed_factor_in_the_end() -> None:
    motion = OrbitMotion()
    motion.scroll(-1.0)

    assert run(motion, START, 200, 0.02).distance == pytest.approx(1000.0 * math.exp(-0.15), rel=1e-3)


def on_picture(camera: Camera, point: tuple[float, float, float]) -> np.ndarray:
    clip = camera.projection(1.5, 1.0, 1e5) @ camera.view_matrix() @ [*point, 1.0]
    return np.asarray(clip[:2] / clip[3])


def test_the_wheel_keeps_the_point_under_the_pointer_in_place() -> None:
    anchor = (220.0, 15.0, -140.0)
    motion = OrbitMotion()
    motion.scroll(-6.0, anchor)
    nearer = run(motion, START, 200, 0.02)

    assert nearer.distance == pytest.approx(1000.0 * math.exp(-0.9), rel=1e-3)
    np.testing.assert_allclose(on_picture(nearer, anchor), on_picture(START, anchor), atol=1e-9)
    motion.scroll(-6.0)
    assert run(motion, START, 200, 0.02).target == pytest.approx(START.target)


def test_a_key_lets_go_of_the_point_under_the_pointer() -> None:
    motion = OrbitMotion()
    motion.scroll(-1.0, (220.0, 15.0, -140.0))
    nearer = run(motion, START, 200, 0.02)
    motion.hold(Move.ZOOM_IN)

    assert run(motion, nearer, 20, 0.02).target == pytest.approx(nearer.target)


def test_a_flight_ends_exactly_where_it_should() -> None:
    end = Camera((500.0, 20.0, -300.0), 50.0, -3.0, 1.2)
    motion = OrbitMotion()
    motion.fly_to(START, end, 1.0)
    camera = run(motion, START, 30, 0.05)

    assert camera == end
    assert not motion.is_moving


def test_a_flight_turns_the_short_way_and_moves_steadily() -> None:
    flight = Flight(
        Camera((0.0, 0.0, 0.0), 10.0, 3.0, 0.5), Camera((100.0, 0.0, 0.0), 1000.0, -3.0, 0.5), 2.0
    )
    poses = [flight.at(t) for t in np.linspace(0.0, 2.0, 50)]
    turned = sum(abs(math.remainder(b.azimuth - a.azimuth, math.tau)) for a, b in pairwise(poses))

    assert turned == pytest.approx(math.tau - 6.0)
    assert all(a.target[0] <= b.target[0] for a, b in pairwise(poses))
    assert flight.at(0.0) == flight.start


def test_a_key_ends_a_flight() -> None:
    motion = OrbitMotion()
    motion.fly_to(START, Camera((500.0, 0.0, 0.0), 50.0, 0.0, 1.0))
    motion.hold(Move.ZOOM_IN)

    assert run(motion, START, 100, 0.05).target == pytest.approx(START.target)


def test_the_target_glides_onto_the_ground_and_the_eye_stays_above() -> None:
    def ground(x: object, z: object) -> object:
        return 100.0 + 0.0 * np.asarray(x)

    motion = OrbitMotion()
    camera = Camera((0.0, 0.0, 0.0), 50.0, 0.0, 0.1)
    for _ in range(200):
        camera = motion.advance(camera, 0.02, ground, clearance=3.0)
        assert camera.eye[1] >= 103.0 - 1e-9

    assert camera.target[1] == pytest.approx(100.0, abs=0.1)


def test_losing_the_keyboard_releases_every_key() -> None:
    motion = OrbitMotion()
    motion.hold(Move.PAN_LEFT)
    motion.release_all()

    assert not motion.is_moving
