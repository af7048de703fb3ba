import math

import numpy as np
import pytest

from protocol import GridGeometry
from viewer.world import Camera, FlowField, Heightfield, arrow_speed, flow_arrows
from viewer.world.flow_arrows import LONGEST_PX, SPACING_PX

GRID = GridGeometry(nrows=200, ncols=300, dx=10.0, x0=0.0, y0=0.0)
GROUND = Heightfield(GRID, np.zeros(GRID.shape, np.float32))
DEEP = np.full(GRID.shape, 1.0, np.float32)
DOWN, LOW = math.pi / 2, math.radians(20.0)


def stream(u: float, v: float, fast: float = 2.0) -> FlowField:
    east, north = np.full(GRID.shape, u, np.float32), np.full(GRID.shape, v, np.float32)
    return FlowField(east, north, east, north, fast)


def records(camera: Camera, flow: FlowField, depth: np.ndarray = DEEP, alpha: float = 0.0) -> np.ndarray:
    return flow_arrows(camera, 16 / 9, GROUND, GROUND.frame, (depth, depth), flow, alpha).records


@pytest.mark.parametrize("distance", [150.0, 700.0, 2500.0, 9000.0])
def test_from_any_height_arrows_stand_apart_and_fill_the_picture(distance: float) -> None:
    arrows = records(Camera((0.0, 0.0, 0.0), distance, 0.0, DOWN), stream(1.0, 0.0))
    pixel = 2.0 * math.tan(math.radians(22.5)) * distance / 720.0
    gaps = np.diff(np.unique(arrows[:, 0])) / pixel

    assert 3 <= len(arrows) < 800
    assert gaps.min() >= 0.95 * SPACING_PX
    if distance > 300.0:  # nearer there is an arrow in every cell
        assert gaps.min() <= 2.1 * SPACING_PX


def test_a_low_view_carries_few_arrows_near_the_horizon() -> None:
    arrows = records(Camera((0.0, 0.0, -800.0), 900.0, 0.0, LOW), stream(0.0, 1.0))
    widths = arrows[:, 4]

    assert len(arrows) < 900
    assert widths.max() > 2.5 * widths.min()


def test_arrows_point_with_the_flow_and_are_long_by_its_speed() -> None:
    camera = Camera((0.0, 0.0, 0.0), 700.0, 0.0, DOWN)
    pixel = 2.0 * math.tan(math.radians(22.5)) * 700.0 / 720.0
    fast, slow = records(camera, stream(-1.2, 1.6)), records(camera, stream(-0.6, 0.8))
    middle = np.argmin(np.hypot(fast[:, 0], fast[:, 1]))
    length = np.hypot(fast[:, 2], fast[:, 3])

    assert fast[middle, 2] / fast[middle, 3] == pytest.approx(-0.75, rel=1e-5)
    assert fast[middle, 2] < 0.0
    assert length[middle] == pytest.approx(LONGEST_PX * pixel, rel=0.02)
    assert np.hypot(slow[:, 2], slow[:, 3]) == pytest.approx(0.5 * length, rel=1e-5)


def test_no_arrow_stands_in_shallow_or_still_water() -> None:
    camera = Camera((0.0, 0.0, 0.0), 700.0, 0.0, DOWN)
    half = DEEP.copy()
    half[:, :150] = 0.04
    arrows = records(camera, stream(1.0, 0.0), half)

    assert len(arrows) > 10
    assert (arrows[:, 0] > -10.0).all()
    assert len(records(camera, stream(0.01, 0.0))) == 0


def test_between_two_frames_the_flow_turns_steadily() -> None:
    camera = Camera((0.0, 0.0, 0.0), 700.0, 0.0, DOWN)
    east, north = stream(1.0, 0.0), stream(0.0, 1.0)
    turning = FlowField(east.u_first, east.v_first, north.u_first, north.v_first, 2.0)
    half = records(camera, turning, alpha=0.5)

    assert half[:, 2] == pytest.approx(half[:, 3], rel=1e-5)


def test_the_speed_of_the_longest_arrow_is_round() -> None:
    speeds = (0.0, 0.1, 0.11, 0.9, 1.0, 3.0, 7.0, 12.0)

    assert [arrow_speed(speed) for speed in speeds] == pytest.approx(
        [0.1, 0.1, 0.2, 1.0, 1.0, 5.0, 10.0, 20.0]
    )
