"""How wrong each block is at each level of detail, ahead of time.

Level l keeps every 2^l-th vertex and splits each square along the diagonal from south-west to north-east.
Its error is the largest vertical distance between the coarse triangles and the ground. Coarse edges run along
fine edges, so the largest distance lies at a grid vertex and nothing between vertices needs looking at.
"""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from viewer.lod.block_tiling import BlockTiling

__all__ = ["BlockBounds", "block_bounds", "block_errors"]

Array = npt.NDArray[np.float32]


@dataclass
class BlockBounds:
    """Lowest and highest ground of each block [m], shape [block_rows, block_cols]."""

    z_min: Array
    z_max: Array


def block_bounds(z: Array, tiling: BlockTiling) -> BlockBounds:
    """Lowest and highest ground of each block.

    Args:
        z: elevation [m], shape [nrows, ncols].
        tiling: the blocks.
    """
    return BlockBounds(
        np.asarray(tiling.reduce(np.minimum, z), dtype=np.float32),
        np.asarray(tiling.reduce(np.maximum, z), dtype=np.float32),
    )


def block_errors(z: Array, tiling: BlockTiling) -> Array:
    """Largest vertical error of each block at each level; level 0 has none.

    Args:
        z: elevation [m], shape [nrows, ncols].
        tiling: the blocks.

    Returns:
        errors [m], shape [level_count, block_rows, block_cols].
    """
    z, tiling = tiling.fitted(z), tiling.drawn
    errors = np.zeros((tiling.level_count, tiling.block_rows, tiling.block_cols), dtype=np.float32)

    def fill(level: int) -> None:
        errors[level] = tiling.reduce(np.maximum, np.abs(_coarse_surface(z, level) - z))

    # NumPy lets go of the interpreter lock in these loops, so the levels share the cores.
    with ThreadPoolExecutor(max_workers=2) as pool:
        list(pool.map(fill, range(1, tiling.level_count)))
    return errors


def _coarse_surface(z: Array, level: int) -> Array:
    """The triangles of one level of all blocks, seen at every vertex drawn, of the shape of z."""
    row0, row1, t = _brackets(z.shape[0], level)
    col0, col1, s = _brackets(z.shape[1], level)
    # Along each kept row first, so that only two gathers of full width remain.
    south_west, south_east = z[np.ix_(row0, col0)], z[np.ix_(row0, col1)]
    north_west, north_east = z[np.ix_(row1, col0)], z[np.ix_(row1, col1)]
    t2, s2 = t[:, None], s[None, :]
    lower = south_west + s2 * (south_east - south_west) + t2 * (north_east - south_east)
    upper = south_west + t2 * (north_west - south_west) + s2 * (north_east - north_west)
    return np.where(s2 >= t2, lower, upper)


def _brackets(count: int, level: int) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64], Array]:
    """For each vertex the kept vertices before and after it, and where between them it lies (0 to 1)."""
    step = 1 << level
    index = np.arange(count)
    before = (index >> level) << level
    after = np.minimum(before + step, count - 1)
    span = np.maximum(after - before, 1)
    return before, after, ((index - before) / span).astype(np.float32)
