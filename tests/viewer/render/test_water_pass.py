import math
from collections.abc import Callable

import numpy as np
import pytest

from viewer.render import FrameInputs, RenderOptions, WaterFrame, WaterPair
from viewer.render.water_pass import ripple_slopes
from viewer.world import Camera, Heightfield

BARE = {"show_sky": False, "show_skirt": False, "fog": False, "background": (1.0, 0.0, 1.0)}


def test_ripples_repeat_without_a_seam_and_lean_nowhere() -> None:
    slopes = ripple_slopes(64).astype(int)
    inside = np.abs(np.diff(slopes, axis=1)).max()

    assert np.abs(slopes[:, 0] - slopes[:, -1]).max() <= inside
    assert np.abs(slopes[0] - slopes[-1]).max() <= np.abs(np.diff(slopes, axis=0)).max()
    assert slopes.mean(axis=(0, 1)) == pytest.approx([127.5, 127.5], abs=2.0)


def flood(stage, field: Heightfield, depth: float, elevation_deg: float) -> np.ndarray:
    frame = WaterFrame(depth, np.full(field.z_b.shape, depth, dtype=np.float32))
    camera = Camera((0.0, 0.0, 0.0), 800.0, 0.6, math.radians(elevation_deg))
    return stage.draw(FrameInputs(camera, WaterPair(frame, frame), options=RenderOptions(**BARE))).astype(int)


@pytest.mark.gl
def test_shallow_water_shows_the_ground_and_deep_water_hides_it(
    make_heightfield: Callable, make_stage: Callable
) -> None:
    stripes = np.zeros((64, 64, 3), dtype=np.uint8)
    stripes[:, ::4], stripes[:, 1::4] = 240, 240
    field = make_heightfield(129, 129, height=0.0001)
    field.cover(None, stripes)
    stage = make_stage(field)
    contrast = [flood(stage, field, depth, 70.0)[..., 1].std() for depth in (0.05, 0.3, 1.0, 8.0)]

    assert contrast == sorted(contrast, reverse=True)
    assert contrast[0] > 20.0
    assert contrast[3] < 0.25 * contrast[0]


@pytest.mark.gl
def test_water_mirrors_more_of_the_sky_at_a_flat_angle(
    make_heightfield: Callable, make_stage: Callable
) -> None:
    field = make_heightfield(129, 129, height=0.0001)
    stage = make_stage(field)
    steep, flat = flood(stage, field, 10.0, 80.0)[150:], flood(stage, field, 10.0, 6.0)[150:]

    assert flat.mean() > steep.mean() + 20.0


@pytest.mark.gl
def test_only_blocks_with_water_are_drawn_as_water(make_heightfield: Callable, make_stage: Callable) -> None:
    field = make_heightfield(129, 129)
    stage = make_stage(field)
    h = np.zeros(field.z_b.shape, dtype=np.float32)
    h[40, 40] = 2.0
    frame = WaterFrame("puddle", h)
    camera = Camera((0.0, 0.0, 0.0), 2500.0, 0.0, math.pi / 2)
    stage.draw(FrameInputs(camera, WaterPair(frame, frame), options=RenderOptions(**BARE)))

    assert stage.stats.water_blocks == 1
    assert stage.stats.water_triangles <= 2 * 32 * 32
    assert stage.stats.terrain_blocks == 16
