"""What fitting an edge to a coarser neighbour costs, ahead of time.

Where a block of level l meets a neighbour of level L > l, the vertices on the shared edge slide to those
that the neighbour has, and the strip of squares along the edge is split into other triangles than level l
has. The error of that strip belongs to no level of either block, so it is charged to the neighbour: a level
L of block n is allowed only where, in each block b beside it, the strip is within the bound too, whatever
level b then has.

With strip(l, L) the error of b's strip and e_b the errors of b itself, b has level l while
e_b[l] <= x < e_b[l + 1], where x is the error that the screen allows. The charge for L is the least x from
which on the strip is within x at the level that b then has:

    charge[L] = max over l < L of  min(strip(l, L), e_b[l + 1])  where strip(l, L) > e_b[l]
"""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import numpy.typing as npt

from viewer.lod.block_tiling import BlockTiling

__all__ = ["edge_errors"]

Array = npt.NDArray[np.float32]


def edge_errors(z: Array, tiling: BlockTiling, errors: Array) -> Array:
    """The error charged to each block and level for the strips that it forces upon its neighbours.

    Args:
        z: elevation [m], shape [nrows, ncols].
        tiling: the blocks.
        errors: errors of the blocks themselves [m], shape [level_count, block_rows, block_cols].

    Returns:
        charges [m], shape [level_count, block_rows, block_cols].
    """
    z, tiling = tiling.fitted(z), tiling.drawn
    monotone = np.maximum.accumulate(errors, axis=0)
    turned = BlockTiling(tiling.ncols, tiling.nrows, tiling.block_size)
    across, along = np.ascontiguousarray(z.T), np.ascontiguousarray(z)
    # West and east edges are the south and north edges of the transposed ground: the diagonals stay the same.
    with ThreadPoolExecutor(max_workers=2) as pool:
        rows = pool.submit(_charges, along, tiling, monotone)
        cols = pool.submit(_charges, across, turned, np.ascontiguousarray(monotone.transpose(0, 2, 1)))
        return np.asarray(np.maximum(rows.result(), cols.result().transpose(0, 2, 1)), dtype=np.float32)


def _charges(z: Array, tiling: BlockTiling, monotone: Array) -> Array:
    """Charges across south and north edges, shape [level_count, block_rows, block_cols]."""
    charges = np.zeros_like(monotone)
    for row in range(tiling.block_rows):
        first, last = int(tiling.row_start[row]), int(tiling.row_end[row])
        if row > 0:
            own = monotone[:, row]
            np.maximum(charges[:, row - 1], _charge(z, tiling, own, first, last), out=charges[:, row - 1])
        if row < tiling.block_rows - 1:
            own = monotone[:, row]
            np.maximum(charges[:, row + 1], _charge(z, tiling, own, last, first), out=charges[:, row + 1])
    return charges


def _charge(z: Array, tiling: BlockTiling, own: Array, edge: int, opposite: int) -> Array:
    """Charge to the neighbours beyond one edge of a row of blocks, shape [level_count, block_cols].

    Args:
        z: elevation [m].
        tiling: the blocks.
        own: monotone errors of the row of blocks, shape [level_count, block_cols].
        edge: row of the shared edge.
        opposite: row of the other edge of the blocks.
    """
    charge = np.zeros_like(own)
    toward = 1 if opposite > edge else -1
    for level in range(tiling.level_count - 1):
        inner = edge + toward * min(1 << level, abs(opposite - edge))
        for coarser in range(level + 1, tiling.level_count):
            strip = _strip_error(z, tiling, edge, inner, level, coarser)
            wanting = strip > own[level]
            due = np.where(wanting, np.minimum(strip, own[level + 1]), 0.0)
            np.maximum(charge[coarser], due, out=charge[coarser])
    return charge


def _strip_error(z: Array, tiling: BlockTiling, edge: int, inner: int, level: int, coarser: int) -> Array:
    """Largest error of the strip between two rows, its edge fitted to a coarser level, shape [block_cols].

    At a share t of the way from the edge to the inner row, the triangles cut the row into straight pieces
    between the lines edge vertex - inner vertex and edge vertex - next inner vertex (or the reverse where the
    edge lies north of the inner row).
    """
    ncols = tiling.ncols
    kept = np.append(np.arange(0, ncols - 1, 1 << level), ncols - 1)
    fitted = (kept >> coarser) << coarser
    fitted[-1] = ncols - 1
    z_edge, z_inner = z[edge, fitted].astype(np.float64), z[inner, kept].astype(np.float64)
    columns = np.arange(ncols)
    error = np.zeros(ncols)
    for row in range(min(edge, inner), max(edge, inner) + 1):
        t = (row - edge) / (inner - edge)
        x = np.empty(2 * kept.size - 1)
        value = np.empty_like(x)
        x[::2], value[::2] = (1.0 - t) * fitted + t * kept, (1.0 - t) * z_edge + t * z_inner
        if inner > edge:
            x[1::2] = (1.0 - t) * fitted[:-1] + t * kept[1:]
            value[1::2] = (1.0 - t) * z_edge[:-1] + t * z_inner[1:]
        else:
            x[1::2] = (1.0 - t) * fitted[1:] + t * kept[:-1]
            value[1::2] = (1.0 - t) * z_edge[1:] + t * z_inner[:-1]
        np.maximum(error, np.abs(np.interp(columns, x, value) - z[row]), out=error)
    by_block = np.maximum(np.maximum.reduceat(error, tiling.col_start), error[tiling.col_end])
    return by_block.astype(np.float32)
