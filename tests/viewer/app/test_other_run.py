"""Two runs side by side: each half of the picture is that run's own picture, pixel for pixel."""

import dataclasses

import moderngl
import numpy as np
import pytest

from tests.viewer.app.conftest import Flight
from tests.viewer.app.test_comparison import branched
from tests.viewer.tiny_service import INTERVAL
from viewer.app.stage import Stage
from viewer.commands import CommandError, CompareWith, MoveSwipe, Seek
from viewer.render import FrameInputs
from viewer.world import Heightfield

SIZE = (320, 180)


class Still:
    """A scene that does not change."""

    def __init__(self, heightfield: Heightfield, inputs: FrameInputs) -> None:
        self.heightfield = heightfield
        self.inputs = inputs

    def frame_inputs(self) -> FrameInputs:
        return self.inputs

    def note_painted(self, size: tuple[int, int]) -> None:
        pass

    def take_picture_order(self) -> None:
        return None

    def complain(self, sentence: str) -> None:
        raise AssertionError(sentence)


def picture(ctx: moderngl.Context, heightfield: Heightfield, inputs: FrameInputs) -> np.ndarray:
    stage = Stage(Still(heightfield, inputs), lambda: ctx)
    stage.open()
    target = ctx.simple_framebuffer(SIZE)
    stage.paint_to(target, SIZE)
    pixels = stage.pixels(target, SIZE)
    ctx.detect_framebuffer(0).use()
    stage.close()
    target.release()
    return pixels


def swiped(flight: Flight, at: float) -> FrameInputs:
    """The inputs of a picture with a branch with a levee left and its parent right of the divider."""
    parent, _ = branched(flight)
    flight.do(Seek(30 * INTERVAL))
    flight.settle()
    flight.do(CompareWith(parent, "swipe"), MoveSwipe(at))
    beside = flight.app.comparison.beside
    assert beside is not None
    flight.until(lambda: beside.feed.pair is not None and beside.feed.keys is not None)
    flight.until(lambda: beside.feed.keys[0][1] == 30)
    flight.settle()
    inputs = flight.app.frame_inputs()
    assert inputs is not None
    return inputs


def test_left_is_the_run_itself_and_right_the_other_pixel_for_pixel(
    flight: Flight, ctx: moderngl.Context
) -> None:
    inputs = swiped(flight, 0.4)
    beside = inputs.beside
    assert beside is not None
    ground = flight.shown.heightfield
    bare = dataclasses.replace(inputs, hud=None)
    both = picture(ctx, ground, bare)
    ours = picture(ctx, ground, dataclasses.replace(bare, beside=None))
    theirs = picture(ctx, beside.heightfield, beside.inputs)
    divider = round(0.4 * SIZE[0])

    assert np.array_equal(both[:, :divider], ours[:, :divider])
    assert np.array_equal(both[:, divider:], theirs[:, divider:])
    assert not np.array_equal(ours[:, divider:], theirs[:, divider:])
    assert not np.array_equal(ours[:, :divider], theirs[:, :divider])


def test_each_side_has_the_edits_and_the_water_of_its_run(flight: Flight) -> None:
    inputs = swiped(flight, 0.5)
    beside = inputs.beside
    assert beside is not None
    assert inputs.edits is not None
    assert inputs.edits.sign.any()
    assert beside.inputs.edits is None
    assert (beside.heightfield.z_b != flight.shown.heightfield.z_b).any()
    assert inputs.water is not None
    assert beside.inputs.water is not None
    assert inputs.water.first.h[36, 60] == 0.0
    assert beside.inputs.water.first.h[36, 60] > 1.0
    assert (beside.left, beside.right) == ("branch from 00:01:40", "run tiny")
    assert inputs.difference is None


def test_the_names_and_the_divider_are_on_the_picture(flight: Flight, ctx: moderngl.Context) -> None:
    inputs = swiped(flight, 0.5)
    ground = flight.shown.heightfield
    text = picture(ctx, ground, inputs).astype(int)
    bare = picture(ctx, ground, dataclasses.replace(inputs, hud=None)).astype(int)
    column = text[:, SIZE[0] // 2]

    assert (column.min(axis=1) > 240).mean() > 0.8
    assert (bare[:, SIZE[0] // 2].min(axis=1) > 240).mean() < 0.2
    amber = (np.abs(text - [242, 176, 32]).max(axis=2) < 30) & (np.abs(bare - text).max(axis=2) > 20)
    assert amber[:, : SIZE[0] // 2].any()
    assert amber[:, SIZE[0] // 2 :].any()


def test_both_move_with_the_time_and_the_divider_stays_on_the_picture(flight: Flight) -> None:
    swiped(flight, 0.5)
    beside = flight.app.comparison.beside
    assert beside is not None
    flight.do(Seek(33 * INTERVAL), MoveSwipe(7.0))
    flight.until(lambda: beside.feed.keys is not None and beside.feed.keys[0][1] == 33)
    status = flight.app.fresh_status()

    assert status.swipe_at == 0.97
    assert status.compare_mode == "swipe"
    with pytest.raises(CommandError, match="MoveSwipe"):
        flight.do(MoveSwipe(float("nan")))
    with pytest.raises(CommandError, match="mode"):
        flight.do(CompareWith(None, "sideways"))
    flight.do(CompareWith(None))
    flight.until(lambda: flight.app.fresh_status().swipe_at is None)
    inputs = flight.app.frame_inputs()
    assert inputs is not None
    assert inputs.beside is None
