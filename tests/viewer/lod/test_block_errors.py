from itertools import pairwise

import numpy as np
import pytest

from viewer.lod import BlockTiling, block_bounds, block_errors


def slow_error(z: np.ndarray, tiling: BlockTiling, row: int, col: int, level: int) -> float:
    """One block the long way: each coarse triangle, each vertex in it, by barycentric coordinates."""
    step = 1 << level
    rows = [*range(int(tiling.row_start[row]), int(tiling.row_end[row]), step), int(tiling.row_end[row])]
    cols = [*range(int(tiling.col_start[col]), int(tiling.col_end[col]), step), int(tiling.col_end[col])]
    worst = 0.0
    for r0, r1 in pairwise(rows):
        for c0, c1 in pairwise(cols):
            for corners in (((r0, c0), (r0, c1), (r1, c1)), ((r0, c0), (r1, c1), (r1, c0))):
                matrix = np.array([[r, c, 1.0] for r, c in corners]).T
                for r in range(r0, r1 + 1):
                    for c in range(c0, c1 + 1):
                        weights = np.linalg.solve(matrix, [r, c, 1.0])
                        if weights.min() > -1e-9:
                            surface = sum(w * z[p] for w, p in zip(weights, corners, strict=True))
                            worst = max(worst, abs(float(surface - z[r, c])))
    return worst


def test_errors_are_those_of_the_triangles(rng: np.random.Generator) -> None:
    z = rng.normal(size=(40, 23)).astype(np.float32)
    tiling = BlockTiling(40, 23, 17)
    errors = block_errors(z, tiling)
    for level in range(tiling.level_count):
        for row in range(tiling.block_rows):
            for col in range(tiling.block_cols):
                expected = slow_error(z, tiling, row, col, level)
                assert errors[level, row, col] == pytest.approx(expected, abs=2e-6)


def test_a_plane_has_no_error_at_any_level() -> None:
    rows, cols = np.meshgrid(np.arange(70.0), np.arange(90.0), indexing="ij")
    z = (0.5 * rows - 0.25 * cols).astype(np.float32)

    assert block_errors(z, BlockTiling(70, 90)).max() < 1e-5


def test_a_single_spike_is_an_error_of_its_height() -> None:
    z = np.zeros((65, 65), dtype=np.float32)
    z[10, 11] = 7.0
    errors = block_errors(z, BlockTiling(65, 65))

    assert errors[0].max() == 0.0
    assert (errors[1:, 0, 0] == 7.0).all()
    assert errors[:, 1, :].max() == 0.0


def test_bounds_hold_shared_edges() -> None:
    z = np.zeros((65, 65), dtype=np.float32)
    z[32, 5], z[40, 32] = 9.0, -4.0
    bounds = block_bounds(z, BlockTiling(65, 65))

    assert bounds.z_max.tolist() == [[9.0, 0.0], [9.0, 0.0]]
    assert bounds.z_min.tolist() == [[0.0, 0.0], [-4.0, -4.0]]
