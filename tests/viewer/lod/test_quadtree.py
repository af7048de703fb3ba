import math

import numpy as np
import pytest

from protocol import GridGeometry
from tests.viewer.conftest import hills
from viewer.lod import BlockQuadtree, BlockTiling, Border, block_bounds
from viewer.world import Camera, Frustum, WorldFrame

DX = 10.0
SIZES = [(65, 65), (300, 90), (70, 410), (261, 277), (2, 2)]


def boxes(tiling: BlockTiling, z: np.ndarray, frame: WorldFrame, grid: GridGeometry) -> np.ndarray:
    """Centres and half sizes of all blocks, one at a time, [2, 3, block_count]."""
    bounds = block_bounds(z, tiling)
    found = []
    for row in range(tiling.block_rows):
        for col in range(tiling.block_cols):
            west, south = grid.center(tiling.row_start[row], tiling.col_start[col])
            east, north = grid.center(tiling.row_end[row], tiling.col_end[col])
            low = np.array(frame.to_world(west, north, bounds.z_min[row, col]))
            high = np.array(frame.to_world(east, south, bounds.z_max[row, col]))
            found.append([0.5 * (low + high), 0.5 * np.abs(high - low)])
    return np.array(found).transpose(1, 2, 0)


def random_view(rng: np.random.Generator, reach: float) -> Camera:
    x, z = rng.uniform(-reach, reach, 2)
    return Camera(
        (x, 20.0, z), rng.uniform(20.0, 20.0 + reach), rng.uniform(-3.0, 3.0), rng.uniform(0.05, 1.5)
    )


@pytest.mark.parametrize("shape", SIZES)
@pytest.mark.parametrize("border", list(Border))
@pytest.mark.parametrize("block_size", [17, 33])
def test_every_block_with_its_box_in_view_is_a_candidate(
    shape: tuple[int, int], border: Border, block_size: int
) -> None:
    rng = np.random.default_rng(shape[0])
    z = hills(*shape, DX, 80.0, seed=shape[1])
    grid = GridGeometry(nrows=shape[0], ncols=shape[1], dx=DX, x0=0.0, y0=0.0)
    tiling = BlockTiling(*shape, block_size, border)
    frame = WorldFrame.of_grid(grid, -80.0).exaggerated(2.0)
    tree = BlockQuadtree(tiling, DX, block_bounds(z, tiling))
    centre, half = boxes(tiling, z, frame, grid)
    for _ in range(20):
        camera = random_view(rng, 0.6 * DX * max(shape))
        frustum = Frustum(camera.projection(1.6, 1e-2, 1e7) @ camera.view_matrix())
        candidates = tree.candidates(frustum, frame)

        assert np.unique(candidates).size == candidates.size
        assert set(np.flatnonzero(frustum.intersects_boxes(centre, half))) <= set(candidates)


def test_a_narrow_view_asks_for_few_blocks() -> None:
    shape = (1025, 1025)
    grid = GridGeometry(nrows=shape[0], ncols=shape[1], dx=DX, x0=0.0, y0=0.0)
    tiling = BlockTiling(*shape, 17)
    flat = np.zeros(shape, np.float32)
    tree = BlockQuadtree(tiling, DX, block_bounds(flat, tiling))
    camera = Camera((0.0, 0.0, 0.0), 400.0, 0.3, math.radians(40.0))
    frustum = Frustum(camera.projection(1.6, 1e-2, 1e7) @ camera.view_matrix())

    assert tree.candidates(frustum, WorldFrame.of_grid(grid)).size < 0.05 * tiling.block_count


def test_ground_that_rose_into_view_is_found_only_after_a_refresh() -> None:
    shape = (257, 257)
    grid = GridGeometry(nrows=shape[0], ncols=shape[1], dx=DX, x0=0.0, y0=0.0)
    tiling = BlockTiling(*shape)
    bounds = block_bounds(np.zeros(shape, np.float32), tiling)
    frame = WorldFrame.of_grid(grid)
    tree = BlockQuadtree(tiling, DX, bounds)
    # Looking level, high above the plain.
    camera = Camera((0.0, 3000.0, 0.0), 1500.0, 0.0, 0.0)
    frustum = Frustum(camera.projection(1.6, 1e-2, 1e7) @ camera.view_matrix())
    bounds.z_max[0, :] = 3000.0

    assert tree.candidates(frustum, frame).size == 0
    tree.refresh()
    assert tree.candidates(frustum, frame).size > 0


def test_water_lifts_the_spheres() -> None:
    shape = (257, 257)
    grid = GridGeometry(nrows=shape[0], ncols=shape[1], dx=DX, x0=0.0, y0=0.0)
    tiling = BlockTiling(*shape)
    tree = BlockQuadtree(tiling, DX, block_bounds(np.zeros(shape, np.float32), tiling))
    camera = Camera((0.0, 3000.0, 0.0), 1500.0, 0.0, 0.0)
    frustum = Frustum(camera.projection(1.6, 1e-2, 1e7) @ camera.view_matrix())

    assert tree.candidates(frustum, WorldFrame.of_grid(grid)).size == 0
    assert tree.candidates(frustum, WorldFrame.of_grid(grid), 3000.0).size == tiling.block_count
