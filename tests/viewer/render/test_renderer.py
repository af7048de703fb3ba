"""Facts about whole pictures, each with a mutant that must break it."""

import math
from collections.abc import Callable

import moderngl
import numpy as np
import pytest

from tests.viewer.render.views import BARE, INSIDE, VIEWS, magenta_pixels
from viewer.render import (
    FrameInputs,
    RenderOptions,
    march_ray,
)
from viewer.world import Camera, Heightfield

pytestmark = pytest.mark.gl


def triangle_height(field: Heightfield, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Ground on the full-resolution triangles, split from south-west to north-east."""
    nrows, ncols = field.z_b.shape
    row, col = field.grid.to_cell(x, y)
    r = np.clip(np.floor(row).astype(int), 0, nrows - 2)
    c = np.clip(np.floor(col).astype(int), 0, ncols - 2)
    t, s = row - r, col - c
    z = field.z_b.astype(np.float64)
    sw, se, nw, ne = z[r, c], z[r, c + 1], z[r + 1, c], z[r + 1, c + 1]
    return np.where(s >= t, sw + s * (se - sw) + t * (ne - se), sw + t * (nw - sw) + s * (ne - nw))


def screen_errors(stage, field: Heightfield, camera: Camera) -> np.ndarray:
    """Pixels between each drawn point of the ground and the true ground above or below it."""
    depth, back = stage.renderer.read_depth()
    rows, cols = np.nonzero(depth < 1.0)
    drawn = back.world(cols, rows, depth[rows, cols])
    x, y = drawn[:, 0] + field.frame.x_centre, field.frame.y_centre - drawn[:, 2]
    inner = field.grid.dx
    xmin, ymin, xmax, ymax = field.grid.extent
    keep = (x > xmin + inner) & (x < xmax - inner) & (y > ymin + inner) & (y < ymax - inner)
    true = drawn[keep].copy()
    true[:, 1] = field.frame.height(triangle_height(field, x[keep], y[keep]))
    width, height = stage.size
    view = camera.projection(width / height, 1.0, 1e5) @ camera.view_matrix()

    def pixels(points: np.ndarray) -> np.ndarray:
        clip = np.column_stack([points, np.ones(len(points))]) @ view.T
        return clip[:, :2] / clip[:, 3:] * [width / 2, height / 2]

    return np.linalg.norm(pixels(true) - pixels(drawn[keep]), axis=1)


# --- no cracks ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("block_size", [17, 33, 65])
def test_no_crack_shows_between_blocks_of_any_levels(
    hilly: Heightfield, make_stage: Callable, block_size: int
) -> None:
    stage = make_stage(hilly)
    for camera in INSIDE:
        for tau in (2.0, 8.0, 30.0):
            options = RenderOptions(tau_px=tau, block_size=block_size, **BARE)
            picture = stage.draw(FrameInputs(camera, options=options))
            assert magenta_pixels(picture) == 0


def test_without_fitted_edges_cracks_do_show(hilly: Heightfield, make_stage: Callable) -> None:
    stage = make_stage(hilly)
    cracks = [
        magenta_pixels(
            stage.draw(FrameInputs(c, options=RenderOptions(tau_px=8.0, snap_edges=False, **BARE)))
        )
        for c in INSIDE
    ]

    assert sum(cracks) > 20


def test_a_terrain_that_fits_no_block_is_covered_to_its_last_row(
    make_heightfield: Callable, make_stage: Callable
) -> None:
    field = make_heightfield(75, 131)
    camera = Camera((0.0, 0.0, 0.0), 2500.0, 0.0, math.pi / 2)
    lod = make_stage(field).draw(FrameInputs(camera, options=RenderOptions(tau_px=4.0, **BARE)))
    full = make_stage(field).draw(FrameInputs(camera, options=RenderOptions(full_mesh=True, **BARE)))

    assert 0 < magenta_pixels(full) < full.shape[0] * full.shape[1]
    assert abs(magenta_pixels(lod) - magenta_pixels(full)) < 60


# --- the screen error asked for is kept ---------------------------------------------------------------


@pytest.mark.parametrize("tau", [1.0, 2.0, 6.0])
def test_the_ground_is_drawn_within_the_screen_error_asked_for(
    hilly: Heightfield, make_stage: Callable, tau: float
) -> None:
    stage = make_stage(hilly, (640, 360))
    for camera in VIEWS:
        stage.draw(FrameInputs(camera, options=RenderOptions(tau_px=tau, **BARE)))
        errors = screen_errors(stage, hilly, camera)
        # A rasteriser extrapolates the depth of slivers at will: a pixel or two may be off.
        assert (errors > tau).sum() <= 2


def test_a_shifted_or_raised_ground_breaks_the_error_bound(hilly: Heightfield, make_stage: Callable) -> None:
    camera = VIEWS[5]
    stage = make_stage(hilly, (640, 360))
    stage.draw(FrameInputs(camera, options=RenderOptions(tau_px=2.0, **BARE)))
    raised, shifted = (
        Heightfield(hilly.grid, hilly.z_b + 5.0),
        Heightfield(hilly.grid, np.roll(hilly.z_b, 1, 1)),
    )
    for mutant in (raised, shifted):
        mutant.frame = hilly.frame
        assert (screen_errors(stage, mutant, camera) > 2.0).mean() > 0.02


def test_the_full_mesh_is_the_ground_itself(hilly: Heightfield, make_stage: Callable) -> None:
    stage = make_stage(hilly, (640, 360))
    for camera in VIEWS:
        stage.draw(FrameInputs(camera, options=RenderOptions(full_mesh=True, **BARE)))
        assert np.percentile(screen_errors(stage, hilly, camera), 99.0) < 0.1


def test_an_edit_is_drawn_within_the_error_at_once(hilly: Heightfield, make_stage: Callable) -> None:
    stage = make_stage(hilly, (640, 360))
    camera = Camera((0.0, 40.0, 0.0), 900.0, 0.9, math.radians(30.0))
    inputs = FrameInputs(camera, options=RenderOptions(tau_px=6.0, **BARE))
    stage.draw(inputs)
    edited = hilly.z_b.copy()
    edited[120:124, 100:200] += 25.0
    hilly.set(edited, (120, 100, 124, 200))
    stage.draw(inputs)

    assert (screen_errors(stage, hilly, camera) > 6.0).sum() <= 2


def test_level_of_detail_saves_most_triangles_in_few_draws(hilly: Heightfield, make_stage: Callable) -> None:
    stage = make_stage(hilly)
    stage.draw(FrameInputs(VIEWS[4], options=RenderOptions(tau_px=3.0, **BARE)))
    assert stage.stats.terrain_triangles < 0.25 * 2 * 256 * 320
    assert stage.stats.draws <= 8


def test_the_triangles_drawn_are_those_counted(
    hilly: Heightfield, make_stage: Callable, ctx: moderngl.Context
) -> None:
    stage = make_stage(hilly)
    stage.draw(FrameInputs(VIEWS[0]))
    query = ctx.query(primitives=True)
    with query:
        stage.draw(FrameInputs(VIEWS[0], options=RenderOptions(full_mesh=True, cull=False, **BARE)))

    # The last pass adds its one triangle.
    assert query.primitives == stage.stats.terrain_triangles + 1


# --- culling -------------------------------------------------------------------------------------------


def test_culling_changes_no_pixel(hilly: Heightfield, make_stage: Callable) -> None:
    stage = make_stage(hilly)
    for camera in VIEWS:
        culled = stage.draw(FrameInputs(camera, options=RenderOptions(**BARE)))
        count = stage.stats.culled_blocks
        whole = stage.draw(
            FrameInputs(camera, options=RenderOptions(cull=False, show_sky=False, show_skirt=False))
        )
        whole = stage.draw(FrameInputs(camera, options=RenderOptions(cull=False, **BARE)))
        different = (np.abs(culled.astype(int) - whole).max(axis=2) > 2).mean()
        # The clip planes follow the boxes in view, so depths round differently.
        assert different < 0.002
        assert stage.stats.culled_blocks == 0
        if camera in INSIDE:
            assert count > 20


# --- picking -------------------------------------------------------------------------------------------


def test_a_picked_place_lies_under_the_mouse(hilly: Heightfield, make_stage: Callable) -> None:
    stage = make_stage(hilly, (640, 360))
    for camera in VIEWS:
        stage.draw(FrameInputs(camera))
        matrix = camera.projection(640 / 360, 1.0, 1e5) @ camera.view_matrix()
        for x, y in ((320.0, 200.0), (251.0, 303.0), (400.5, 250.5)):
            place = stage.renderer.pick(x, y)
            assert place is not None
            clip = matrix @ [*hilly.frame.to_world(*place), 1.0]
            px, py = (clip[0] / clip[3] + 1.0) * 320.0, (1.0 - clip[1] / clip[3]) * 180.0
            assert (px, py) == pytest.approx((math.floor(x) + 0.5, math.floor(y) + 0.5), abs=0.05)


def test_a_picked_place_lies_on_the_ground_and_agrees_with_the_ray(
    hilly: Heightfield, make_stage: Callable
) -> None:
    stage = make_stage(hilly, (640, 360))
    camera = VIEWS[0]
    stage.draw(FrameInputs(camera, options=RenderOptions(full_mesh=True)))
    for column, row in ((320, 180), (100, 300), (500, 90)):
        place = stage.renderer.pick(column, row)
        assert place is not None
        ray = march_ray(
            camera, (column + 0.5) / 320.0 - 1.0, 1.0 - (row + 0.5) / 180.0, 640 / 360, hilly, hilly.frame
        )
        assert ray is not None
        assert place[2] == pytest.approx(hilly.sample(place[0], place[1]), abs=0.3)
        assert math.dist(place, ray) < 1.5


def test_the_sky_and_places_outside_of_the_picture_are_nowhere(
    hilly: Heightfield, make_stage: Callable
) -> None:
    stage = make_stage(hilly)
    assert stage.renderer.pick(10.0, 10.0) is None
    stage.draw(FrameInputs(Camera((0.0, 300.0, 0.0), 3000.0, 0.0, math.radians(3.0))))

    assert stage.renderer.pick(240.0, 2.0) is None
    assert stage.renderer.pick(-1.0, 50.0) is None
    assert stage.renderer.pick(50.0, 300.0) is None


# --- options and targets --------------------------------------------------------------------------------


def test_multisampling_smooths_and_still_lets_depth_be_read(hilly: Heightfield, make_stage: Callable) -> None:
    stage = make_stage(hilly)
    plain = stage.draw(FrameInputs(VIEWS[4]))
    one = stage.renderer.pick(240.0, 170.0)
    smooth = stage.draw(FrameInputs(VIEWS[4], options=RenderOptions(samples=4)))
    four = stage.renderer.pick(240.0, 170.0)

    assert one is not None
    assert four is not None
    assert math.dist(one, four) < 40.0
    assert 0 < (plain != smooth).any(axis=2).mean() < 0.5


@pytest.mark.parametrize(
    "option",
    [
        {"wireframe": True},
        {"show_blocks": True},
        {"contour_interval": 5.0},
        {"exaggeration": 2.0},
        {"light_azimuth_deg": 120.0},
        {"show_terrain": False},
        {"show_skirt": False},
        {"show_sky": False},
        {"fog": False},
    ],
)
def test_every_option_changes_the_picture(hilly: Heightfield, make_stage: Callable, option: dict) -> None:
    stage = make_stage(hilly, (320, 200))
    camera = Camera((0.0, 40.0, 0.0), 2800.0, 0.9, math.radians(20.0))
    plain = stage.draw(FrameInputs(camera))
    other = stage.draw(FrameInputs(camera, options=RenderOptions(**option)))

    assert (plain != other).any(axis=2).mean() > 0.002


@pytest.mark.parametrize("scale", [0.5, 2.0])
def test_another_render_scale_shows_the_same_scene_and_picks_the_same_places(
    hilly: Heightfield, make_stage: Callable, scale: float
) -> None:
    stage = make_stage(hilly)
    plain = stage.draw(FrameInputs(VIEWS[4])).astype(int)
    place = stage.renderer.pick(200.0, 190.0)
    scaled = stage.draw(FrameInputs(VIEWS[4], options=RenderOptions(render_scale=scale))).astype(int)
    other = stage.renderer.pick(200.0, 190.0)

    assert scaled.shape == plain.shape
    assert 0.0 < np.abs(plain - scaled).mean() < 6.0
    assert place is not None
    assert other is not None
    assert math.dist(place, other) < 60.0


def test_a_picture_may_change_its_size(
    hilly: Heightfield, make_stage: Callable, ctx: moderngl.Context
) -> None:
    stage = make_stage(hilly, (320, 200))
    stage.draw(FrameInputs(VIEWS[4]))
    framebuffer = ctx.simple_framebuffer((200, 320))
    stage.renderer.draw(framebuffer, (200, 320), FrameInputs(VIEWS[4]))

    assert stage.renderer.read_pixels(framebuffer, (200, 320)).shape == (320, 200, 3)
    framebuffer.release()


def test_imagery_is_laid_north_side_up(hilly: Heightfield, make_stage: Callable) -> None:
    imagery = np.zeros((64, 64, 3), dtype=np.uint8)
    imagery[:32, :, 0], imagery[32:, :, 2] = 220, 220  # red south, blue north
    hilly.cover(None, imagery)
    stage = make_stage(hilly)
    picture = stage.draw(
        FrameInputs(Camera((0.0, 0.0, 0.0), 1500.0, 0.0, math.pi / 2), options=RenderOptions(**BARE))
    )
    north, south = picture[40:120].mean(axis=(0, 1)), picture[180:260].mean(axis=(0, 1))

    assert north[2] > 2.0 * north[0]
    assert south[0] > 2.0 * south[2]
