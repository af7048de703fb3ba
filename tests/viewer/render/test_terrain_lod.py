import numpy as np

from viewer.lod import BlockTiling
from viewer.render import EditOverlay, FrameInputs
from viewer.render.terrain_lod import TerrainLod
from viewer.world import Camera, Heightfield

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


def test_edited_blocks_are_drawn_at_full_resolution(hilly: Heightfield) -> None:
    lod = TerrainLod(hilly, BlockTiling(*hilly.z_b.shape))
    sign = np.zeros(hilly.z_b.shape, dtype=np.int8)
    sign[32, 40] = 1  # on an edge: both blocks hold the vertex
    lod.follow_edits(EditOverlay(1, sign))
    level = levels(lod, hilly).level.reshape(8, 10)

    assert level[0, 1] == level[1, 1] == 0
    lod.follow_edits(None)
    assert levels(lod, hilly).level.max() > 0


def test_an_edited_block_keeps_its_ground_under_water(hilly: Heightfield) -> None:
    lod = TerrainLod(hilly, BlockTiling(*hilly.z_b.shape))
    states = np.full(80, 2, dtype=np.uint8)
    assert levels(lod, hilly, states).stats.terrain_blocks == 0

    sign = np.zeros(hilly.z_b.shape, dtype=np.int8)
    sign[130:135, 150:156] = 1
    lod.follow_edits(EditOverlay(1, sign))
    selection = levels(lod, hilly, states)
    assert 1 <= selection.stats.terrain_blocks <= 2
