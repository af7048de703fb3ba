"""Blocks of any size and border: no crack, the screen error kept, and what is past the data marked."""

import math
from collections.abc import Callable

import numpy as np
import pytest

from protocol import BlockLayout
from tests.viewer.render.test_renderer import screen_errors
from tests.viewer.render.views import BARE, INSIDE, VIEWS, magenta_pixels
from viewer.lod import BLOCK_SIZES, Border
from viewer.render import FrameInputs, RenderOptions, WaterFrame, WaterPair
from viewer.world import Camera, Heightfield

pytestmark = pytest.mark.gl

ABOVE = Camera((0.0, 0.0, 0.0), 3400.0, 0.0, math.pi / 2)
NO_DATA = (140, 143, 145)


def states_of_the_wire(depth: np.ndarray) -> np.ndarray:
    return BlockLayout(*depth.shape).classify((depth > 0.0).astype(np.uint16))


def grey_pixels(picture: np.ndarray) -> int:
    return int((np.abs(picture.astype(int) - NO_DATA) <= 2).all(axis=2).sum())


@pytest.mark.parametrize("block_size", BLOCK_SIZES)
@pytest.mark.parametrize("border", list(Border))
def test_no_crack_shows_for_any_size_and_border(
    make_heightfield: Callable, make_stage: Callable, block_size: int, border: Border
) -> None:
    stage = make_stage(make_heightfield(270, 330), (240, 150))
    cracks = {True: 0, False: 0}
    for fitted in cracks:
        for camera in (*INSIDE, Camera((200.0, 40.0, 100.0), 260.0, 1.2, math.radians(32.0))):
            options = RenderOptions(
                tau_px=9.0, block_size=block_size, border=border, snap_edges=fitted, **BARE
            )
            cracks[fitted] += magenta_pixels(stage.draw(FrameInputs(camera, options=options)))

    assert cracks[True] == 0
    assert cracks[False] > 5


@pytest.mark.parametrize("block_size", [17, 65])
@pytest.mark.parametrize("border", [Border.TRIM, Border.PAD])
def test_the_screen_error_is_kept_for_any_size_and_border(
    make_heightfield: Callable, make_stage: Callable, block_size: int, border: Border
) -> None:
    field = make_heightfield(270, 330)
    stage = make_stage(field, (400, 225))
    for camera in VIEWS[::2]:
        options = RenderOptions(tau_px=2.0, block_size=block_size, border=border, **BARE)
        stage.draw(FrameInputs(camera, options=options))
        assert (screen_errors(stage, field, camera) > 2.0).sum() <= 2


def test_trimming_draws_less_padding_more_and_only_padding_is_marked(
    make_heightfield: Callable, make_stage: Callable
) -> None:
    stage = make_stage(make_heightfield(270, 330), (400, 320))
    drawn, grey = {}, {}
    for border in Border:
        picture = stage.draw(FrameInputs(ABOVE, options=RenderOptions(border=border, **BARE)))
        drawn[border] = picture.shape[0] * picture.shape[1] - magenta_pixels(picture)
        grey[border] = grey_pixels(picture)

    assert drawn[Border.TRIM] < drawn[Border.RAGGED] < drawn[Border.PAD]
    assert grey[Border.TRIM] == grey[Border.RAGGED] == 0
    assert abs(grey[Border.PAD] - (drawn[Border.PAD] - drawn[Border.RAGGED])) < 0.05 * grey[Border.PAD]


@pytest.mark.parametrize("block_size", BLOCK_SIZES)
def test_water_shows_the_same_through_blocks_of_every_size(
    make_heightfield: Callable, make_stage: Callable, block_size: int
) -> None:
    field = make_heightfield(270, 330)
    depth = np.maximum(np.float32(20.0) - field.z_b, 0.0).astype(np.float32)
    frame = WaterFrame("lake", depth)
    stage = make_stage(field, (240, 150))
    exact = {"partial_spacing_px": 0.0, "water_spacing_px": 0.0}
    for border in Border:
        options = RenderOptions(block_size=block_size, border=border, tau_px=0.5, **exact, **BARE)
        water = WaterPair(frame, frame)
        ours = stage.draw(FrameInputs(INSIDE[1], water, options=options))
        reference = RenderOptions(full_mesh=True, classify_water=False, **exact, **BARE)
        theirs = stage.draw(FrameInputs(INSIDE[1], water, options=reference))
        differs = (np.abs(ours.astype(int) - theirs).max(axis=2) > 12).mean()
        assert differs < 0.02
        dry = stage.draw(FrameInputs(INSIDE[1], options=options))
        assert (np.abs(ours.astype(int) - dry).max(axis=2) > 12).mean() > 0.1


def test_wet_padding_has_no_hole(make_heightfield: Callable, make_stage: Callable) -> None:
    field = make_heightfield(270, 330)
    frame = WaterFrame("sea", np.full_like(field.z_b, 3.0))
    stage = make_stage(field, (400, 320))
    options = RenderOptions(border=Border.PAD, **BARE)
    wet = stage.draw(FrameInputs(ABOVE, WaterPair(frame, frame), options=options))
    dry = stage.draw(FrameInputs(ABOVE, options=options))

    assert magenta_pixels(wet) <= magenta_pixels(dry)  # the sea stands a little higher
    assert grey_pixels(wet) > 500


def test_states_of_the_wire_draw_what_the_viewers_own_classes_draw(
    make_heightfield: Callable, make_stage: Callable
) -> None:
    field = make_heightfield(270, 330)
    depth = np.maximum(np.float32(20.0) - field.z_b, 0.0).astype(np.float32)
    stage = make_stage(field, (240, 150))
    for border in Border:
        options = RenderOptions(border=border, **BARE)
        pictures, stats = [], []
        for key, states in (("own", None), ("wire", states_of_the_wire(depth))):
            frame = WaterFrame(key, depth, states)
            pictures.append(stage.draw(FrameInputs(INSIDE[0], WaterPair(frame, frame), options=options)))
            stats.append((stage.stats.water_triangles, stage.stats.covered_blocks))
        assert np.array_equal(*pictures)
        assert stats[0] == stats[1]


def test_round_the_data_there_is_no_wall_and_within_it_the_screen_error_holds(
    make_heightfield: Callable, make_stage: Callable
) -> None:
    hilly = make_heightfield(200, 260)
    outside = np.zeros(hilly.z_b.shape, np.bool_)
    outside[:, 120:] = True
    z = np.where(outside, hilly.z_max + np.float32(100.0), hilly.z_b)
    field, walled = Heightfield(hilly.grid, z, outside), Heightfield(hilly.grid, z)
    camera = Camera((-300.0, 20.0, 0.0), 1500.0, -0.6, math.radians(35.0))
    inputs = FrameInputs(camera, options=RenderOptions(tau_px=3.0, **BARE))
    triangles = []
    for ground in (field, walled):
        stage = make_stage(ground, (400, 225))
        stage.draw(inputs)
        triangles.append(stage.stats.terrain_triangles)
        # Measured against the data alone: pixels beyond it are compared with nothing.
        truth = Heightfield(hilly.grid, np.where(outside, ground.drawn, hilly.z_b))
        truth.frame = ground.frame
        errors = screen_errors(stage, truth, camera)
        assert errors.size > 10_000
        assert (errors > 3.0).sum() <= 2
        truth.drawn = truth.z_b = truth.z_b + np.float32(40.0)
        assert (screen_errors(stage, truth, camera) > 3.0).mean() > 0.02

    assert triangles[0] < 0.9 * triangles[1]
