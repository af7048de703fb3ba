import math

import pytest

from tests.viewer.tiny_service import GRID, valley
from viewer.app.camera_work import CameraWork
from viewer.commands import (
    CommandError,
    DragOrbit,
    DragPan,
    FlyTo,
    GrabView,
    HoldMove,
    Play,
    ReleaseMoves,
    ResetView,
    TopView,
    Zoom,
)
from viewer.world import Heightfield


@pytest.fixture
def work() -> CameraWork:
    return CameraWork(Heightfield(GRID, valley()))


def settle(work: CameraWork) -> None:
    for _ in range(400):
        if not work.is_moving:
            return
        work.advance(0.02)
    raise AssertionError("the camera does not come to rest")


def test_a_flight_of_no_time_is_there_at_once(work: CameraWork) -> None:
    work.carry_out(FlyTo(1300.0, 2400.0, 500.0, 90.0, 30.0, 0.0))
    x, y, _ = work.frame.from_world(work.camera.target)

    assert (x, y) == pytest.approx((1300.0, 2400.0))
    assert work.camera.distance == 500.0
    assert math.degrees(work.camera.azimuth) == pytest.approx(90.0)
    assert not work.is_moving


def test_a_flight_glides_and_arrives(work: CameraWork) -> None:
    start = work.camera.distance
    work.carry_out(FlyTo(1300.0, 2400.0, 300.0, seconds=1.0))
    work.advance(0.5)
    assert 300.0 < work.camera.distance < start
    settle(work)

    assert work.camera.distance == pytest.approx(300.0)


def test_the_top_view_looks_straight_down_with_north_up(work: CameraWork) -> None:
    work.carry_out(TopView())
    settle(work)

    assert math.degrees(work.camera.elevation) == pytest.approx(90.0, abs=1.0)
    assert work.camera.azimuth == pytest.approx(0.0)
    work.carry_out(ResetView())
    settle(work)
    assert math.degrees(work.camera.elevation) < 60.0


def test_drags_the_wheel_and_held_keys_move_the_camera(work: CameraWork) -> None:
    before = work.camera
    for command in (GrabView(True), DragOrbit(0.2, 0.0), DragPan(0.1, 0.1)):
        assert work.carry_out(command)
    work.advance(0.02)
    work.carry_out(GrabView(False))
    assert work.camera.azimuth != before.azimuth
    assert work.camera.target != before.target
    work.carry_out(Zoom(2.0))
    settle(work)
    assert work.camera.distance < before.distance
    work.carry_out(HoldMove("pan_right", True))
    work.advance(0.2)
    moved = work.camera.target
    work.carry_out(ReleaseMoves())
    settle(work)
    assert moved != before.target


def test_an_untouched_view_follows_the_shape_of_the_picture_a_chosen_one_stays(work: CameraWork) -> None:
    before = work.camera.distance
    work.set_aspect(0.5)
    assert work.camera.distance > before
    work.carry_out(FlyTo(1300.0, 2400.0, 500.0, seconds=0.0))
    work.set_aspect(2.0)

    assert work.camera.distance == 500.0


def test_exaggeration_keeps_the_target_on_its_place_on_the_ground(work: CameraWork) -> None:
    work.carry_out(FlyTo(1300.0, 2400.0, 500.0, seconds=0.0))
    place = work.frame.from_world(work.camera.target)
    work.set_exaggeration(3.0)

    assert work.frame.from_world(work.camera.target) == pytest.approx(place)


def test_what_is_no_camera_command_is_left_to_others(work: CameraWork) -> None:
    assert not work.carry_out(Play())


@pytest.mark.parametrize(
    "command", [HoldMove("jump", True), FlyTo(float("nan"), 0.0), FlyTo(0.0, 0.0, distance=0.0)]
)
def test_a_senseless_move_is_refused(work: CameraWork, command: object) -> None:
    with pytest.raises(CommandError):
        work.carry_out(command)  # type: ignore[arg-type]


def test_the_pose_brings_back_the_view(work: CameraWork) -> None:
    work.carry_out(FlyTo(1300.0, 2400.0, 500.0, 40.0, 35.0, seconds=0.0))
    before, pose = work.camera, work.pose()
    work.carry_out(ResetView())
    settle(work)
    assert work.camera.distance != pytest.approx(500.0)
    work.carry_out(pose)
    settle(work)

    assert work.camera.target == pytest.approx(before.target, abs=1e-6)
    assert (work.camera.distance, work.camera.azimuth) == pytest.approx((before.distance, before.azimuth))
