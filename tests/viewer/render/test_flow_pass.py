"""Arrows on the picture: where they are, that they point with the flow, that the ground hides them."""

import math
from collections.abc import Callable

import numpy as np
import pytest

from tests.viewer.render.views import BARE
from viewer.render import FrameInputs, HudText, RenderOptions, WaterFrame, WaterPair
from viewer.world import Camera, FlowField, Heightfield

pytestmark = pytest.mark.gl

ABOVE = Camera((0.0, 0.0, 0.0), 500.0, 0.0, math.pi / 2)


def flow(field: Heightfield, u: float, v: float) -> FlowField:
    east, north = (np.full(field.z_b.shape, part, np.float32) for part in (u, v))
    return FlowField(east, north, east, north, 2.0)


def white_pixels(stage: object, field: Heightfield, u: float, v: float, depth: float = 2.0) -> np.ndarray:
    """Rows and columns of pixels that arrows have turned white."""
    frame = WaterFrame(depth, np.full(field.z_b.shape, depth, np.float32))
    options = RenderOptions(**BARE)
    inputs = [
        FrameInputs(ABOVE, WaterPair(frame, frame), options=options, flow=arrows)
        for arrows in (None, flow(field, u, v))
    ]
    plain, drawn = (stage.draw(each).astype(int) for each in inputs)  # type: ignore[attr-defined]
    return np.argwhere((drawn.min(axis=2) > 250) & (plain.min(axis=2) < 250))


def spread(pixels: np.ndarray) -> tuple[float, float]:
    """Mean height and width of the white spots around each arrow's place."""
    occupied = np.zeros((300, 480), bool)
    occupied[pixels[:, 0], pixels[:, 1]] = True
    down = (occupied[1:] & occupied[:-1]).sum() / max(occupied.sum(), 1)
    along = (occupied[:, 1:] & occupied[:, :-1]).sum() / max(occupied.sum(), 1)
    return float(down), float(along)


def test_arrows_lie_along_the_flow(make_heightfield: Callable, make_stage: Callable) -> None:
    field = make_heightfield(height=4.0)
    stage = make_stage(field)
    east, north = white_pixels(stage, field, 2.0, 0.0), white_pixels(stage, field, 0.0, 2.0)

    assert len(east) > 300
    assert spread(east)[1] > spread(east)[0]
    assert spread(north)[0] > spread(north)[1]


def test_an_arrow_is_broad_at_its_head(make_heightfield: Callable, make_stage: Callable) -> None:
    field = make_heightfield(height=4.0)
    stage = make_stage(field, (480, 300))

    def skew(u: float) -> float:
        """Third moment of the white columns about each spot's middle: the head is heavier than the shaft."""
        pixels = white_pixels(stage, field, u, 0.0)
        picture = np.zeros((300, 480))
        picture[pixels[:, 0], pixels[:, 1]] = 1.0
        from scipy import ndimage

        labels, count = ndimage.label(picture, np.ones((3, 3)))
        total = 0.0
        for spot in ndimage.find_objects(labels, count):
            weights = picture[spot].sum(axis=0)
            at = np.linspace(-1.0, 1.0, len(weights))
            total += float((weights * at).sum() / weights.sum()) if len(weights) > 8 else 0.0
        return total

    assert skew(2.0) > 0.0 > skew(-2.0)


def test_dry_ground_and_thin_films_carry_no_arrow(make_heightfield: Callable, make_stage: Callable) -> None:
    field = make_heightfield(height=4.0)
    stage = make_stage(field)

    assert len(white_pixels(stage, field, 2.0, 0.0, depth=0.03)) == 0


def test_a_legend_says_how_fast_the_longest_arrow_is(
    make_heightfield: Callable, make_stage: Callable
) -> None:
    field = make_heightfield(height=4.0)
    stage = make_stage(field)
    frame = WaterFrame("w", np.full(field.z_b.shape, 2.0, np.float32))
    still = flow(field, 0.0, 0.0)
    pair = WaterPair(frame, frame)
    hud = HudText(scale_and_north=False)
    without = stage.draw(FrameInputs(ABOVE, pair, hud=hud)).astype(int)
    with_legend = stage.draw(FrameInputs(ABOVE, pair, hud=hud, flow=still)).astype(int)
    changed = np.abs(with_legend - without).max(axis=2) > 20

    assert changed[200:, 240:].any()
    assert not changed[:150].any()
