import math
from collections.abc import Callable

import numpy as np
import pytest

from viewer.render import FrameInputs, RenderOptions
from viewer.world import Camera, Heightfield

pytestmark = pytest.mark.gl
BARE = {"show_sky": False, "show_skirt": False, "fog": False, "background": (1.0, 0.0, 1.0)}


def test_one_draw_a_level_is_enough(hilly: Heightfield, make_stage: Callable) -> None:
    stage = make_stage(hilly)
    stage.draw(FrameInputs(Camera((0.0, 20.0, 0.0), 2500.0, 0.4, 0.4), options=RenderOptions(**BARE)))

    assert 2 < stage.stats.draws <= 7  # six levels and the last pass


def test_contours_follow_the_heights(make_heightfield: Callable, make_stage: Callable) -> None:
    field = make_heightfield(129, 129)
    ramp = np.broadcast_to(np.linspace(0.0, 60.0, 129, dtype=np.float32), (129, 129))
    field.set(ramp)
    stage = make_stage(field, (300, 300))
    camera = Camera((0.0, 30.0, 0.0), 1500.0, 0.0, math.pi / 2)
    plain = stage.draw(FrameInputs(camera, options=RenderOptions(**BARE))).astype(int)
    lined = stage.draw(FrameInputs(camera, options=RenderOptions(contour_interval=10.0, **BARE))).astype(int)
    dark = (plain - lined).sum(axis=2)[150] > 15
    lines = np.count_nonzero(np.diff(dark.astype(int)) == 1)

    assert lines in (5, 6, 7)  # 10, 20, ... 50 and perhaps those at the rims


def test_the_block_view_colours_levels_apart(hilly: Heightfield, make_stage: Callable) -> None:
    stage = make_stage(hilly)
    camera = Camera((0.0, 20.0, 0.0), 500.0, 0.4, 0.5)
    fine, coarse = (
        stage.draw(FrameInputs(camera, options=RenderOptions(show_blocks=True, tau_px=tau, **BARE)))
        for tau in (0.1, 300.0)
    )

    assert fine.mean(axis=(0, 1))[0] > fine.mean(axis=(0, 1))[2] + 40.0  # level 0 is red
    assert coarse.mean(axis=(0, 1))[2] > coarse.mean(axis=(0, 1))[1]  # the coarsest is purple
