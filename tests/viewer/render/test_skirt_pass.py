import math
from collections.abc import Callable

import numpy as np
import pytest

from viewer.render import FrameInputs, RenderOptions, WaterFrame, WaterPair
from viewer.world import Camera, Heightfield

pytestmark = pytest.mark.gl
BARE = {"show_sky": False, "fog": False, "background": (1.0, 0.0, 1.0)}


@pytest.mark.parametrize("azimuth_deg", [0.0, 90.0, 180.0, 270.0])
def test_every_side_of_the_map_has_a_wall(
    hilly: Heightfield, make_stage: Callable, azimuth_deg: float
) -> None:
    stage = make_stage(hilly)
    camera = Camera((0.0, -60.0, 0.0), 4500.0, math.radians(azimuth_deg), math.radians(4.0))
    without = stage.draw(FrameInputs(camera, options=RenderOptions(show_skirt=False, **BARE)))
    walled = stage.draw(FrameInputs(camera, options=RenderOptions(**BARE)))
    new = (without == [255, 0, 255]).all(axis=2) & (walled != [255, 0, 255]).any(axis=2)

    assert new.any(axis=0).sum() > 200


def test_water_at_the_border_has_a_side_of_its_own(hilly: Heightfield, make_stage: Callable) -> None:
    stage = make_stage(hilly)
    frame = WaterFrame("deep", np.full(hilly.z_b.shape, 60.0, dtype=np.float32))
    camera = Camera((0.0, -60.0, 0.0), 4500.0, 0.0, math.radians(4.0))
    dry = stage.draw(FrameInputs(camera, options=RenderOptions(**BARE)))
    wet = stage.draw(FrameInputs(camera, WaterPair(frame, frame), options=RenderOptions(**BARE)))
    side = wet[(dry != wet).any(axis=2)].mean(axis=0)

    assert side[2] > side[0] + 40.0
