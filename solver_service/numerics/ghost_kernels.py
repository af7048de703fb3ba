"""Ghost cells: walls mirror the water, open edges let it leave.

A wall reflects depth, tangential velocity and bed, and turns the normal velocity round. An open edge copies
the edge cell; only outward normal velocity is copied, so that an open edge never becomes a source.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import warp as wp

from solver_service.numerics.fields import GHOSTS, TILE, FloatRaster
from solver_service.numerics.warp_modules import SUPPORT_MODULE

WALL = 0
OPEN = 1
WEST, EAST, SOUTH, NORTH = 0, 1, 2, 3


@wp.kernel(module=SUPPORT_MODULE)
def fill_ghost_cells(
    kinds: wp.array2d(dtype=wp.int32),
    ghosts: wp.array(dtype=wp.int32),
    nrows: int,
    ncols: int,
    # outputs
    h: wp.array2d(dtype=wp.float32),
    u: wp.array2d(dtype=wp.float32),
    v: wp.array2d(dtype=wp.float32),
):
    """Fill the listed ghost cells from the cells inside.

    Args:
        kinds: WALL or OPEN, [4, longest edge] for the west, east, south and north edge.
        ghosts: flat padded numbers of the ghost cells to fill.
        nrows: grid rows.
        ncols: grid columns.
        h: depth [m], padded.
        u: velocity [m/s], padded.
        v: velocity [m/s], padded.
    """
    flat = ghosts[wp.tid()]
    i = flat // (ncols + 4)
    j = flat % (ncols + 4)
    row = i - 2
    col = j - 2
    edge_row = wp.clamp(row, 0, nrows - 1)
    edge_col = wp.clamp(col, 0, ncols - 1)
    from_row = edge_row
    from_col = edge_col
    open_x = int(0)
    open_y = int(0)
    if row < 0:
        open_y = kinds[2, edge_col]
        if open_y == 0:
            from_row = wp.min(-1 - row, nrows - 1)
    if row >= nrows:
        open_y = kinds[3, edge_col]
        if open_y == 0:
            from_row = wp.max(2 * nrows - 1 - row, 0)
    if col < 0:
        open_x = kinds[0, edge_row]
        if open_x == 0:
            from_col = wp.min(-1 - col, ncols - 1)
    if col >= ncols:
        open_x = kinds[1, edge_row]
        if open_x == 0:
            from_col = wp.max(2 * ncols - 1 - col, 0)
    u_in = u[from_row + 2, from_col + 2]
    v_in = v[from_row + 2, from_col + 2]
    if col < 0:
        u_in = wp.where(open_x == 1, wp.min(u_in, 0.0), -u_in)
    if col >= ncols:
        u_in = wp.where(open_x == 1, wp.max(u_in, 0.0), -u_in)
    if row < 0:
        v_in = wp.where(open_y == 1, wp.min(v_in, 0.0), -v_in)
    if row >= nrows:
        v_in = wp.where(open_y == 1, wp.max(v_in, 0.0), -v_in)
    h[i, j] = h[from_row + 2, from_col + 2]
    u[i, j] = u_in
    v[i, j] = v_in


def ghost_cells(nrows: int, ncols: int) -> npt.NDArray[np.int32]:
    """Flat padded numbers of all ghost cells."""
    ring = np.ones((nrows + 2 * GHOSTS, ncols + 2 * GHOSTS), bool)
    ring[GHOSTS:-GHOSTS, GHOSTS:-GHOSTS] = False
    return np.flatnonzero(ring).astype(np.int32)


def ghost_tiles(ghosts: npt.NDArray[np.int32], nrows: int, ncols: int) -> npt.NDArray[np.int64]:
    """Compute tile, row-major, that each ghost cell lies at."""
    rows, cols = np.divmod(ghosts, ncols + 2 * GHOSTS)
    tile_rows = np.clip(rows - GHOSTS, 0, nrows - 1) // TILE
    tile_cols = np.clip(cols - GHOSTS, 0, ncols - 1) // TILE
    return (tile_rows * -(-ncols // TILE) + tile_cols).astype(np.int64)


def pad_bed(z_b: FloatRaster, kinds: npt.NDArray[np.int32]) -> FloatRaster:
    """Bed with ghost cells: mirrored at walls, continued level at open edges."""
    nrows, ncols = z_b.shape
    padded = (
        np.pad(z_b, GHOSTS, mode="symmetric")
        if min(nrows, ncols) >= GHOSTS
        else np.pad(z_b, GHOSTS, mode="edge")
    )
    inside_rows, inside_cols = slice(GHOSTS, GHOSTS + nrows), slice(GHOSTS, GHOSTS + ncols)
    for edge, ghost, source in ((WEST, 0, GHOSTS), (EAST, ncols + GHOSTS + 1, ncols + GHOSTS - 1)):
        is_open = kinds[edge, :nrows] == OPEN
        padded[inside_rows, ghost][is_open] = padded[inside_rows, source][is_open]
    for edge, ghost, source in ((SOUTH, 0, GHOSTS), (NORTH, nrows + GHOSTS + 1, nrows + GHOSTS - 1)):
        is_open = kinds[edge, :ncols] == OPEN
        padded[ghost, inside_cols][is_open] = padded[source, inside_cols][is_open]
    return padded.astype(np.float32)
