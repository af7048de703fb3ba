import msgspec
import numpy as np

from protocol import EditLine, EditType, Operation
from viewer.lod import BlockTiling
from viewer.render import EditOverlay, FrameInputs
from viewer.render.terrain_lod import TerrainLod
from viewer.world import Camera, EditDocument, Heightfield

CAMERA = Camera((0.0, 20.0, 0.0), 900.0, 0.4, 0.7)
SIZE = (640, 360)


def levels(lod: TerrainLod, field: Heightfield, states: np.ndarray | None = None):
    return lod.select(FrameInputs(CAMERA), field.frame, SIZE, states, 0.0)


def test_refreshing_an_edit_equals_starting_anew(hilly: Heightfield, rng: np.random.Generator) -> None:
    tiling = BlockTiling(*hilly.z_b.shape)
    lod = TerrainLod(hilly, tiling)
    for rect in ((0, 0, 5, 5), (60, 100, 70, 190), (200, 280, 257, 321), (96, 128, 97, 129)):
        edited = hilly.z_b.copy()
        window = edited[rect[0] : rect[2], rect[1] : rect[3]]
        window += rng.normal(scale=8.0, size=window.shape).astype(np.float32)
        hilly.set(edited, rect)
        lod.refresh(rect)
        fresh = TerrainLod(hilly, tiling)

        assert np.array_equal(lod._table._monotone, fresh._table._monotone)
        assert np.array_equal(lod._table._charges, fresh._table._charges)
        assert np.array_equal(lod._bounds.z_min, fresh._bounds.z_min)
        assert np.array_equal(lod._bounds.z_max, fresh._bounds.z_max)


def test_an_edited_block_has_the_level_that_its_new_errors_ask_for(hilly: Heightfield) -> None:
    whole = (0, 0, *hilly.z_b.shape)
    flat = np.full_like(hilly.z_b, 50.0)
    hilly.set(flat, whole)
    lod = TerrainLod(hilly, BlockTiling(*flat.shape))
    before = levels(lod, hilly).level.reshape(8, 10).copy()
    walled, wall = flat.copy(), (138, 144, 150, 145)
    walled[wall[0] : wall[2], wall[1]] += 40.0
    hilly.set(walled, wall)
    lod.refresh(wall)
    beside_wall = levels(lod, hilly).level.reshape(8, 10).copy()
    hilly.set(flat, wall)
    lod.refresh(wall)

    assert (before > 0).all()  # flat ground, edited or not, needs few triangles
    assert beside_wall[4, 4] == 0
    assert np.count_nonzero(beside_wall != before) <= 2
    assert np.array_equal(levels(lod, hilly).level.reshape(8, 10), before)


def test_an_edited_block_keeps_its_ground_under_water(hilly: Heightfield) -> None:
    lod = TerrainLod(hilly, BlockTiling(*hilly.z_b.shape))
    states = np.full(80, 2, dtype=np.uint8)
    assert levels(lod, hilly, states).stats.terrain_blocks == 0

    sign = np.zeros(hilly.z_b.shape, dtype=np.int8)
    sign[130:135, 150:156] = 1
    lod.follow_edits(EditOverlay(1, sign))
    selection = levels(lod, hilly, states)
    assert 1 <= selection.stats.terrain_blocks <= 2


def test_an_edit_that_is_drawn_moved_and_deleted_leaves_errors_and_levels_as_they_were(
    hilly: Heightfield,
) -> None:
    tiling = BlockTiling(*hilly.z_b.shape)
    lod, document = TerrainLod(hilly, tiling), EditDocument(hilly.grid, hilly.z_b.copy())
    before = levels(lod, hilly).level.copy()
    dx = hilly.grid.dx
    x, y = hilly.grid.x0 + 40.0 * dx, hilly.grid.y0 + 40.0 * dx
    drawn = EditLine("a", ((x, y), (x + 40.0 * dx, y)), 4.0 * dx, Operation.raise_, EditType.modulate, 25.0)
    moved = msgspec.structs.replace(drawn, vertices=((x, y + 90.0 * dx), (x + 40.0 * dx, y + 60.0 * dx)))
    for revision, edits in enumerate(([drawn], [moved], []), 1):
        document.mirror(revision, edits, True, False)
        preview = document.preview()
        assert preview.dirty is not None
        hilly.set(preview.z_b, preview.dirty)
        lod.refresh(preview.dirty)
        lod.follow_edits(EditOverlay(revision, preview.sign))
        fresh = TerrainLod(hilly, tiling)

        assert np.array_equal(lod._table._monotone, fresh._table._monotone)
        assert np.array_equal(lod._table._charges, fresh._table._charges)
        level = levels(lod, hilly).level
        assert np.array_equal(level, levels(fresh, hilly).level)
    assert np.array_equal(level, before)
