import moderngl
import msgspec
import numpy as np
import pytest

from protocol import EditLine, EditType, Operation
from viewer.errors import TerrainDataError
from viewer.render import EditOverlay
from viewer.render.frame_uniforms import sun_direction
from viewer.render.ground_textures import GroundTextures
from viewer.world import EditDocument, Heightfield

pytestmark = pytest.mark.gl
SUN = sun_direction(315.0, 42.0)


@pytest.fixture
def ground(ctx: moderngl.Context, hilly: Heightfield):
    textures = GroundTextures(ctx, hilly)
    textures.follow(SUN, True, None)
    yield textures
    ctx.detect_framebuffer(0).use()
    textures.release()


def heights(ground: GroundTextures) -> np.ndarray:
    return np.frombuffer(ground.height.read(), dtype="<f4").reshape(ground.height.height, ground.height.width)


def colours(ground: GroundTextures) -> np.ndarray:
    size = (ground.colour.height, ground.colour.width, 4)
    return np.frombuffer(ground.colour.read(), dtype=np.uint8).reshape(size).astype(int)


def test_heights_are_uploaded_to_the_bit(ground: GroundTextures, hilly: Heightfield) -> None:
    assert np.array_equal(heights(ground), hilly.z_b)


def test_an_edit_uploads_its_rectangle(ground: GroundTextures, hilly: Heightfield) -> None:
    edited = hilly.z_b.copy()
    edited[50:60, 70:90] += 4.0
    hilly.set(edited, (50, 70, 60, 90))

    assert ground.follow(SUN, True, None) == (50, 70, 60, 90)
    assert np.array_equal(heights(ground), edited)
    assert ground.follow(SUN, True, None) is None


def test_light_is_baked_anew_around_an_edit_as_if_from_the_start(
    ctx: moderngl.Context, ground: GroundTextures, hilly: Heightfield
) -> None:
    before = colours(ground)
    edited = hilly.z_b.copy()
    edited[50:60, 70:90] += 40.0
    edited = np.minimum(edited, hilly.z_max)
    hilly.set(edited, (50, 70, 60, 90))
    ground.follow(SUN, True, None)
    fresh = GroundTextures(ctx, hilly)
    fresh.follow(SUN, True, None)

    assert (np.abs(colours(ground) - before) > 3).any()
    assert np.abs(colours(ground) - colours(fresh)).max() <= 1
    ctx.detect_framebuffer(0).use()
    fresh.release()


def test_an_edit_that_is_drawn_moved_and_deleted_leaves_no_mark_where_it_was(
    ctx: moderngl.Context, ground: GroundTextures, hilly: Heightfield
) -> None:
    before, bed = colours(ground), hilly.z_b.copy()
    document = EditDocument(hilly.grid, bed)
    dx = hilly.grid.dx
    x, y = hilly.grid.x0 + 60.0 * dx, hilly.grid.y0 + 80.0 * dx
    drawn = EditLine("a", ((x, y), (x + 40.0 * dx, y)), 4.0 * dx, Operation.raise_, EditType.modulate, 25.0)
    moved = msgspec.structs.replace(drawn, vertices=((x, y + 90.0 * dx), (x + 40.0 * dx, y + 60.0 * dx)))
    changed = []
    for revision, edits in enumerate(([drawn], [moved], []), 1):
        document.mirror(revision, edits, True, False)
        preview = document.preview()
        hilly.set(preview.z_b, preview.dirty)
        assert ground.follow(SUN, True, EditOverlay(revision, preview.sign)) == preview.dirty
        assert np.array_equal(heights(ground), preview.z_b)
        fresh = GroundTextures(ctx, Heightfield(hilly.grid, preview.z_b))
        fresh.follow(SUN, True, EditOverlay(revision, preview.sign))
        away = np.abs(colours(ground) - colours(fresh)).max(axis=2)
        changed.append(float((np.abs(colours(ground) - before).max(axis=2) > 3).mean()))
        ctx.detect_framebuffer(0).use()
        fresh.release()
        assert np.count_nonzero(away > 3) <= 1e-4 * away.size
    assert changed[0] > 0.005
    assert changed[1] > 0.005
    assert changed[2] == 0.0


def test_slopes_toward_the_sun_are_brighter(ctx: moderngl.Context, hilly: Heightfield) -> None:
    ground = GroundTextures(ctx, hilly)
    ground.follow(sun_direction(90.0, 30.0), True, None)
    light = colours(ground)[..., :3].sum(axis=2)[::2, ::2]
    rises_east = np.gradient(hilly.z_b, axis=1)

    assert np.corrcoef(light.ravel(), rises_east.ravel())[0, 1] < -0.4
    ctx.detect_framebuffer(0).use()
    ground.release()


def test_the_mask_is_uploaded_once_a_revision(ground: GroundTextures, hilly: Heightfield) -> None:
    sign = np.zeros(hilly.z_b.shape, dtype=np.int8)
    sign[3, 4], sign[5, 6] = 1, -1
    ground.follow(SUN, True, EditOverlay(1, sign))
    mask = np.frombuffer(ground.mask.read(alignment=1), dtype=np.uint8).reshape(sign.shape)
    assert (mask[3, 4], mask[5, 6], mask[0, 0]) == (255, 1, 128)

    ground.follow(SUN, True, None)
    assert (np.frombuffer(ground.mask.read(alignment=1), dtype=np.uint8) == 128).all()


def test_a_mask_of_another_size_is_refused(ground: GroundTextures) -> None:
    with pytest.raises(TerrainDataError, match="edit mask"):
        ground.follow(SUN, True, EditOverlay(1, np.zeros((3, 3), dtype=np.int8)))


def test_ground_without_data_is_one_grey_whatever_the_light(
    ctx: moderngl.Context, hilly: Heightfield
) -> None:
    outside = np.zeros(hilly.z_b.shape, np.bool_)
    outside[:, :100] = True
    hilly.cover(outside, None)
    ground = GroundTextures(ctx, hilly)
    pictures = []
    for sun in (SUN, (0.9, 0.1, 0.42)):
        ground.follow(sun, True, None)
        rows, cols = ground.colour.height, ground.colour.width
        baked = np.frombuffer(ground.colour.read(alignment=1), np.uint8).reshape(rows, cols, 4)
        pictures.append(baked)
        left = baked[:, : 98 * cols // outside.shape[1]]
        assert (left == left[0, 0]).all()
        assert left[0, 0, 3] == 0
        assert np.ptp(baked[:, 102 * cols // outside.shape[1] :, 0]) > 40
    assert (pictures[0] != pictures[1]).any()
    ctx.detect_framebuffer(0).use()
    ground.release()
