import moderngl
import numpy as np
import pytest

from viewer.errors import TerrainDataError
from viewer.lod import BlockTiling
from viewer.render import WaterFrame, WaterPair
from viewer.render.water_textures import WaterSlot, WaterTextures, combined_states
from viewer.world import Heightfield

pytestmark = pytest.mark.gl


@pytest.fixture
def water(ctx: moderngl.Context, hilly: Heightfield):
    textures = WaterTextures(ctx, BlockTiling(*hilly.z_b.shape), hilly.grid.dx, hilly.z_b)
    yield textures
    ctx.detect_framebuffer(0).use()
    textures.release()


def single(textures: WaterTextures, frame: WaterFrame) -> WaterSlot:
    return textures.follow(WaterPair(frame, frame))[0]


def drawn_depth(slot: WaterSlot) -> np.ndarray:
    return np.frombuffer(slot.depth.read(), dtype="<f4").reshape(slot.depth.height, slot.depth.width)


def slopes(slot: WaterSlot) -> np.ndarray:
    raw = np.frombuffer(slot.slope.read(), dtype="<f2")
    return raw.reshape(slot.slope.height, slot.slope.width, 2).astype(float)


def slow_depth(h: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Depth continued under dry banks, the long way."""
    nrows, ncols = h.shape
    wet, eta = np.pad(h > 0, 1), np.pad(z.astype(np.float64) + h, 1)
    total, count = np.zeros(h.shape), np.zeros(h.shape)
    for i in range(3):
        for j in range(3):
            near = (slice(i, i + nrows), slice(j, j + ncols))
            total += np.where(wet[near], eta[near], 0.0)
            count += wet[near]
    below = np.minimum(total / np.maximum(count, 1) - z, 0.0)
    return np.where(h > 0, h, np.where(count > 0, below, 0.0))


def lake(field: Heightfield, level: float) -> np.ndarray:
    return np.maximum(level - field.z_b, 0.0).astype(np.float32)


def test_wet_cells_keep_their_depth_to_the_bit(water: WaterTextures, hilly: Heightfield) -> None:
    h = lake(hilly, 0.0)
    depth = drawn_depth(single(water, WaterFrame(1, h)))

    assert np.array_equal(depth[h > 0], h[h > 0])
    assert (depth[h == 0] <= 0.0).all()


def test_dry_banks_continue_the_level_of_the_water(water: WaterTextures, hilly: Heightfield) -> None:
    h = lake(hilly, 0.0)
    depth = drawn_depth(single(water, WaterFrame(1, h)))

    assert depth == pytest.approx(slow_depth(h, hilly.z_b), abs=1e-4)


def test_a_front_running_downhill_is_not_continued(water: WaterTextures, hilly: Heightfield) -> None:
    h = np.where(hilly.z_b > 20.0, 0.5, 0.0).astype(np.float32)
    depth = drawn_depth(single(water, WaterFrame(1, h)))

    assert depth[h == 0].max() == 0.0
    assert depth == pytest.approx(slow_depth(h, hilly.z_b), abs=1e-4)


def test_a_level_lake_has_no_slope_even_at_its_shore(water: WaterTextures, hilly: Heightfield) -> None:
    h = lake(hilly, 0.0)

    assert np.abs(slopes(single(water, WaterFrame(1, h)))[h > 0]).max() < 1e-5


def test_slopes_are_central_differences_of_the_level(water: WaterTextures, hilly: Heightfield) -> None:
    h = np.full(hilly.z_b.shape, 3.0, dtype=np.float32)
    slope = slopes(single(water, WaterFrame(1, h)))
    eta = hilly.z_b.astype(np.float64) + h
    east = (eta[1:-1, 2:] - eta[1:-1, :-2]) / 20.0
    south = (eta[:-2, 1:-1] - eta[2:, 1:-1]) / 20.0

    assert slope[1:-1, 1:-1, 0] == pytest.approx(east, rel=2e-3, abs=1e-3)
    assert slope[1:-1, 1:-1, 1] == pytest.approx(south, rel=2e-3, abs=1e-3)


def test_a_sequence_of_frames_leaves_nothing_of_the_frames_before(
    water: WaterTextures, hilly: Heightfield, rng: np.random.Generator
) -> None:
    for number in range(6):
        h = lake(hilly, float(rng.uniform(-60.0, 60.0)))
        h[:, : int(rng.integers(0, 200))] = 0.0
        assert drawn_depth(single(water, WaterFrame(number, h))) == pytest.approx(
            slow_depth(h, hilly.z_b), abs=1e-4
        )


def test_playing_on_uploads_only_the_new_frame(water: WaterTextures, hilly: Heightfield) -> None:
    a, b, c = (WaterFrame(k, lake(hilly, 5.0 * k)) for k in range(3))
    first, second = water.follow(WaterPair(a, b))
    later = water.follow(WaterPair(b, c))

    assert later[0] is second
    assert later[1] is first
    assert (later[0].key, later[1].key) == (1, 2)
    assert np.array_equal(drawn_depth(later[1])[c.h > 0], c.h[c.h > 0])


def test_an_equal_key_is_trusted(water: WaterTextures, hilly: Heightfield) -> None:
    slot = single(water, WaterFrame("k", lake(hilly, 0.0)))
    again = single(water, WaterFrame("k", lake(hilly, 30.0)))

    assert again is slot
    assert np.array_equal(drawn_depth(again) > 0, lake(hilly, 0.0) > 0)


def test_another_bed_under_the_same_depths_is_derived_anew(water: WaterTextures, hilly: Heightfield) -> None:
    h = lake(hilly, 0.0)
    single(water, WaterFrame("k", h))
    bed = hilly.z_b + np.float32(50.0) * (hilly.z_b > 10.0)
    depth = drawn_depth(single(water, WaterFrame("k", h, z_b=bed)))

    assert depth == pytest.approx(slow_depth(h, bed), abs=1e-4)


def test_given_states_are_used_and_missing_ones_found(water: WaterTextures, hilly: Heightfield) -> None:
    h = lake(hilly, -20.0)
    found = single(water, WaterFrame("a", h)).states
    given = single(water, WaterFrame("b", h, states=found.reshape(8, 10))).states

    assert set(found.tolist()) >= {0, 1}
    assert np.array_equal(found, given)


def test_a_block_between_dry_and_wet_is_partial(water: WaterTextures, hilly: Heightfield) -> None:
    dry = WaterFrame("dry", np.zeros(hilly.z_b.shape, dtype=np.float32))
    wet = WaterFrame("wet", np.full(hilly.z_b.shape, 2.0, dtype=np.float32))
    states, deepest = combined_states(*water.follow(WaterPair(dry, wet, 0.5)))

    assert (states == 1).all()
    assert deepest == 2.0
    assert (combined_states(*water.follow(WaterPair(wet, wet)))[0] == 2).all()


@pytest.mark.parametrize(
    "frame",
    [
        WaterFrame(1, np.zeros((5, 5), dtype=np.float32)),
        WaterFrame(1, np.zeros((257, 321))),
        WaterFrame(1, np.zeros((257, 321), dtype=np.float32), states=np.zeros((3, 3), dtype=np.uint8)),
        WaterFrame(1, np.zeros((257, 321), dtype=np.float32), z_b=np.zeros((5, 5), dtype=np.float32)),
    ],
)
def test_arrays_that_do_not_fit_are_refused(water: WaterTextures, frame: WaterFrame) -> None:
    with pytest.raises(TerrainDataError, match=r"has shape|have shape"):
        single(water, frame)
