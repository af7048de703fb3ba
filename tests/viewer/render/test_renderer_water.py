"""Facts about pictures of water and edits, each with a mutant that must break it where one is known."""

import math
from collections.abc import Callable

import numpy as np
import pytest

from tests.viewer.render.views import BARE, INSIDE, VIEWS, magenta_pixels
from viewer.errors import TerrainDataError
from viewer.render import (
    DepthDifference,
    EditOverlay,
    FrameInputs,
    HudText,
    RenderOptions,
    WaterFrame,
    WaterPair,
)
from viewer.world import Camera, Heightfield

pytestmark = pytest.mark.gl


# --- water ---------------------------------------------------------------------------------------------


def lake(field: Heightfield, level: float) -> np.ndarray:
    return np.maximum(level - field.z_b, 0.0).astype(np.float32)


def drawn_heights(stage) -> np.ndarray:
    """World height of what is drawn at each pixel [m], lowest row first."""
    depth, back = stage.renderer.read_depth()
    rows, cols = np.mgrid[: depth.shape[0], : depth.shape[1]]
    return back.world(cols, rows, depth)[..., 1]


def wet_pixels(stage, field: Heightfield, h: np.ndarray, camera: Camera, **options: object) -> tuple:
    """Where water lies before the ground, and the greatest and least depth of the cells around each pixel."""
    plain = {**BARE, **options}
    stage.draw(FrameInputs(camera, options=RenderOptions(**plain)))
    ground = drawn_heights(stage)
    frame = WaterFrame("lake", h)
    stage.draw(FrameInputs(camera, WaterPair(frame, frame), options=RenderOptions(**plain)))
    depth, back = stage.renderer.read_depth()
    changed = drawn_heights(stage) > ground + 0.05
    rows, cols = np.mgrid[: depth.shape[0], : depth.shape[1]]
    world = back.world(cols, rows, depth)
    grid = field.grid
    row, col = grid.to_cell(world[..., 0] + field.frame.x_centre, field.frame.y_centre - world[..., 2])
    r = np.clip(np.rint(row).astype(int), 0, grid.nrows - 1)
    c = np.clip(np.rint(col).astype(int), 0, grid.ncols - 1)
    reach = np.stack(
        [
            h[np.clip(r + i, 0, grid.nrows - 1), np.clip(c + j, 0, grid.ncols - 1)]
            for i in (-1, 0, 1)
            for j in (-1, 0, 1)
        ]
    )
    on_map = depth < 1.0
    return (
        changed & on_map,
        np.where(on_map, reach.max(axis=0), 0.0),
        np.where(on_map, reach.min(axis=0), 0.0),
    )


def test_water_shows_where_cells_are_wet_and_nowhere_else(hilly: Heightfield, make_stage: Callable) -> None:
    stage = make_stage(hilly, (640, 360))
    h = lake(hilly, -10.0)
    for camera in (
        Camera((0.0, 0.0, 0.0), 1200.0, 2.0, math.radians(65.0)),
        Camera((0.0, 0.0, 0.0), 900.0, 0.9, math.radians(50.0)),
    ):
        shown, deepest_near, shallowest_near = wet_pixels(stage, hilly, h, camera, full_mesh=True)
        assert 0.05 < shown.mean() < 0.9
        assert not (shown & (deepest_near == 0.0)).any()
        assert shown[shallowest_near > 0.5].mean() > 0.999


def test_water_that_is_not_there_fails_that_test(hilly: Heightfield, make_stage: Callable) -> None:
    stage = make_stage(hilly, (640, 360))
    h = lake(hilly, -10.0)
    shown, _, _ = wet_pixels(
        stage, hilly, h, Camera((0.0, 0.0, 0.0), 1200.0, 2.0, math.radians(65.0)), full_mesh=True
    )
    stage.draw(
        FrameInputs(Camera((0.0, 0.0, 0.0), 1200.0, 2.0, math.radians(65.0)), options=RenderOptions(**BARE))
    )
    _, elsewhere, _ = wet_pixels(
        stage,
        hilly,
        np.roll(h, 40, 1),
        Camera((0.0, 0.0, 0.0), 1200.0, 2.0, math.radians(65.0)),
        full_mesh=True,
    )

    assert (shown & (elsewhere == 0.0)).sum() > 100


def test_under_wet_blocks_nothing_shows_through(hilly: Heightfield, make_stage: Callable) -> None:
    stage = make_stage(hilly)
    deep = WaterFrame("deep", np.full(hilly.z_b.shape, 4.0, dtype=np.float32))
    film = WaterFrame("film", np.full(hilly.z_b.shape, 0.004, dtype=np.float32))
    for water in (deep, film):
        for camera in INSIDE:
            picture = stage.draw(FrameInputs(camera, WaterPair(water, water), options=RenderOptions(**BARE)))
            assert magenta_pixels(picture) == 0
            assert stage.stats.terrain_triangles == 0
            assert stage.stats.covered_blocks > 0


def test_no_crack_shows_between_water_and_ground(hilly: Heightfield, make_stage: Callable) -> None:
    stage = make_stage(hilly)
    water = WaterFrame("lake", lake(hilly, 5.0))
    for camera in INSIDE:
        for spacing in (0.0, 6.0):
            options = RenderOptions(tau_px=8.0, water_spacing_px=spacing, partial_spacing_px=spacing, **BARE)
            picture = stage.draw(FrameInputs(camera, WaterPair(water, water), options=options))
            assert magenta_pixels(picture) == 0


def test_a_film_too_thin_to_show_looks_like_the_ground(hilly: Heightfield, make_stage: Callable) -> None:
    stage = make_stage(hilly)
    film = WaterFrame("film", np.full(hilly.z_b.shape, 0.004, dtype=np.float32))
    options = RenderOptions(full_mesh=True, depth_shown=0.01, **BARE)
    ground = stage.draw(FrameInputs(INSIDE[0], options=options))
    wet = stage.draw(FrameInputs(INSIDE[0], WaterPair(film, film), options=options))

    assert np.abs(ground.astype(int) - wet).mean() < 1.0


def test_between_two_frames_water_rises_steadily(hilly: Heightfield, make_stage: Callable) -> None:
    stage = make_stage(hilly, (320, 200))
    camera = Camera((0.0, 0.0, 0.0), 900.0, 0.0, math.pi / 2)
    low, high = WaterFrame("low", lake(hilly, -30.0)), WaterFrame("high", lake(hilly, 20.0))
    dry = stage.draw(FrameInputs(camera, options=RenderOptions(**BARE))).astype(int)
    wet = []
    for alpha in (0.0, 0.25, 0.5, 0.75, 1.0):
        picture = stage.draw(FrameInputs(camera, WaterPair(low, high, alpha), options=RenderOptions(**BARE)))
        wet.append(int((np.abs(picture - dry).max(axis=2) > 12).sum()))

    assert wet == sorted(wet)
    assert wet[0] < wet[2] < wet[4]


def test_a_frame_that_dried_up_leaves_no_water_behind(hilly: Heightfield, make_stage: Callable) -> None:
    stage = make_stage(hilly)
    camera, options = INSIDE[0], RenderOptions(**BARE)
    dry = stage.draw(FrameInputs(camera, options=options))
    for number, level in enumerate((30.0, -20.0, 10.0)):
        frame = WaterFrame(number, lake(hilly, level))
        stage.draw(FrameInputs(camera, WaterPair(frame, frame), options=options))
    nothing = WaterFrame("dry", np.zeros(hilly.z_b.shape, dtype=np.float32))
    picture = stage.draw(FrameInputs(camera, WaterPair(nothing, nothing), options=options))

    assert np.array_equal(picture, dry)


def test_the_same_frame_drawn_again_is_the_same_picture(hilly: Heightfield, make_stage: Callable) -> None:
    stage = make_stage(hilly)
    frame = WaterFrame("lake", lake(hilly, 0.0))
    inputs = FrameInputs(VIEWS[4], WaterPair(frame, frame), hud=HudText(title="a", time="b"))

    assert np.array_equal(stage.draw(inputs), stage.draw(inputs))


def test_a_raised_preview_stands_out_of_the_water_at_an_unchanged_level(
    hilly: Heightfield, make_stage: Callable
) -> None:
    stage = make_stage(hilly)
    camera = Camera((0.0, 0.0, 0.0), 600.0, 0.0, math.pi / 2)
    bed = hilly.z_b
    frame = WaterFrame("flood", np.full(bed.shape, 2.0, dtype=np.float32), z_b=bed)
    edited = bed.copy()
    edited[110:150, 158:163] += 3.0
    hilly.set(edited, (110, 158, 150, 163))
    sign = np.sign(edited - bed).astype(np.int8)
    picture = stage.draw(
        FrameInputs(camera, WaterPair(frame, frame), EditOverlay(1, sign), RenderOptions(**BARE))
    )
    place = stage.renderer.pick(240.0, 150.0)

    assert place is not None
    assert place[2] == pytest.approx(hilly.sample(place[0], place[1]), abs=0.2)
    assert magenta_pixels(picture) == 0
    aside = stage.renderer.pick(400.0, 150.0)
    assert aside is not None
    assert aside[2] == pytest.approx(hilly.sample(aside[0], aside[1]) + 2.0, abs=0.2)


def test_while_the_bed_falls_between_two_frames_the_level_is_blended(
    hilly: Heightfield, make_stage: Callable
) -> None:
    stage = make_stage(hilly)
    camera = Camera((0.0, 0.0, 0.0), 300.0, 0.0, math.pi / 2)
    before = hilly.z_b.copy()
    after = before - np.float32(4.0)
    first = WaterFrame("a", np.full(before.shape, 1.0, np.float32), z_b=before)
    second = WaterFrame("b", np.full(before.shape, 3.0, np.float32), z_b=after)
    hilly.set(0.5 * (before + after))
    stage.draw(FrameInputs(camera, WaterPair(first, second, 0.5), options=RenderOptions(**BARE)))
    place = stage.renderer.pick(240.0, 150.0)

    assert place is not None
    # Levels 1 m above the old and 3 m above the new bed, which lies 4 m lower: half way, the old bed itself.
    rise = 0.5 * (1.0 + 3.0 - 4.0)
    assert place[2] == pytest.approx(hilly.sample(place[0], place[1]) + 2.0 + rise, abs=0.1)


def test_water_of_another_size_is_refused(hilly: Heightfield, make_stage: Callable) -> None:
    stage = make_stage(hilly)
    frame = WaterFrame("small", np.zeros((10, 10), dtype=np.float32))

    with pytest.raises(TerrainDataError, match=r"water depth has shape \(10, 10\)"):
        stage.draw(FrameInputs(VIEWS[0], WaterPair(frame, frame)))


# --- edits ---------------------------------------------------------------------------------------------


def test_raised_ground_is_warm_and_lowered_ground_is_cool(hilly: Heightfield, make_stage: Callable) -> None:
    stage = make_stage(hilly)
    camera = Camera((0.0, 0.0, 0.0), 600.0, 0.0, math.pi / 2)
    sign = np.zeros(hilly.z_b.shape, dtype=np.int8)
    sign[:, :160], sign[:, 161:] = 1, -1
    plain = stage.draw(FrameInputs(camera, options=RenderOptions(**BARE))).astype(int)
    marked = stage.draw(
        FrameInputs(camera, edits=EditOverlay(1, sign), options=RenderOptions(**BARE))
    ).astype(int)
    again = stage.draw(FrameInputs(camera, options=RenderOptions(**BARE))).astype(int)
    left, right = marked[:, 10:200].mean(axis=(0, 1)), marked[:, 280:470].mean(axis=(0, 1))

    assert left[0] > left[2] + 60.0
    assert right[2] > right[0] + 60.0
    assert np.array_equal(plain, again)


def test_a_comparison_colours_ground_and_water_where_the_depths_differ(
    hilly: Heightfield, make_stage: Callable
) -> None:
    stage = make_stage(hilly)
    shape = hilly.z_b.shape
    camera = Camera((0.0, 40.0, 0.0), 2500.0, 0.0, math.pi / 2)
    h = np.zeros(shape, np.float32)
    h[:, 160:] = 2.0
    frame = WaterFrame("wet", h)
    metres = np.zeros(shape, np.float32)
    metres[40:120, :] = 1.5  # south: deeper here
    metres[140:220, :] = -1.5  # north: shallower here

    def draw(difference: DepthDifference | None) -> np.ndarray:
        inputs = FrameInputs(camera, WaterPair(frame, frame), difference=difference)
        return stage.draw(inputs).astype(int)

    plain, compared = draw(None), draw(DepthDifference("d", metres, "run"))
    again = draw(None)
    height, width = plain.shape[:2]
    north, south = slice(height // 2 - 30, height // 2 - 15), slice(height // 2 + 15, height // 2 + 30)
    dry, wet = slice(width // 2 - 60, width // 2 - 20), slice(width // 2 + 20, width // 2 + 60)

    assert np.array_equal(plain, again)
    for cols in (dry, wet):
        deeper, shallower = compared[south, cols].mean(axis=(0, 1)), compared[north, cols].mean(axis=(0, 1))
        assert deeper[0] > deeper[1] + 40  # purple
        assert shallower[1] > shallower[0] + 25  # green
    unchanged = compared[:8, dry], plain[:8, dry]
    assert np.abs(unchanged[0] - unchanged[1]).max() <= 2
