"""Which compute tiles can change: wet ones, those with a source, and the neighbours of both.

Water crosses at most one cell in a step, so a list of wet tiles and their neighbours stays valid for as many steps as a
tile has cells on a side. Water no deeper than `depth_film` does not move by itself and does not make a tile wet.
"""

import warp as wp

from solver_service.numerics.warp_modules import SUPPORT_MODULE

SIDE = wp.constant(32)


@wp.kernel(module=SUPPORT_MODULE)
def classify_tiles(
    h: wp.array2d(dtype=wp.float32),
    depth_film: float,
    nrows: int,
    ncols: int,
    tile_cols: int,
    active: wp.array(dtype=wp.int32),
    # outputs
    wet: wp.array(dtype=wp.int32),
    tile_count: wp.array(dtype=wp.int32),
):
    """`wet` is 1 for tiles with a cell deeper than the film; a tile that was not active cannot be."""
    tile = wp.tid()
    if tile == 0:
        tile_count[0] = 0
    found = int(0)
    if active[tile] == 1:
        row0 = (tile // tile_cols) * SIDE + 2
        col0 = (tile % tile_cols) * SIDE + 2
        row1 = wp.min(row0 + SIDE, nrows + 2)
        col1 = wp.min(col0 + SIDE, ncols + 2)
        i = int(row0)
        while i < row1 and found == 0:
            j = int(col0)
            while j < col1 and found == 0:
                if h[i, j] > depth_film:
                    found = 1
                j += 1
            i += 1
    wet[tile] = found


@wp.kernel(module=SUPPORT_MODULE)
def list_active_tiles(
    h: wp.array2d(dtype=wp.float32),
    u: wp.array2d(dtype=wp.float32),
    v: wp.array2d(dtype=wp.float32),
    wet: wp.array(dtype=wp.int32),
    forced: wp.array(dtype=wp.int32),
    nrows: int,
    ncols: int,
    tile_rows: int,
    tile_cols: int,
    # outputs
    h_out: wp.array2d(dtype=wp.float32),
    u_out: wp.array2d(dtype=wp.float32),
    v_out: wp.array2d(dtype=wp.float32),
    active: wp.array(dtype=wp.int32),
    tiles: wp.array(dtype=wp.int32),
    tile_count: wp.array(dtype=wp.int32),
):
    """List the tiles to compute; a tile that falls asleep gets the same state in both buffers."""
    tile = wp.tid()
    tile_row = tile // tile_cols
    tile_col = tile % tile_cols
    now = int(0)
    for a in range(wp.max(tile_row - 1, 0), wp.min(tile_row + 2, tile_rows)):
        for b in range(wp.max(tile_col - 1, 0), wp.min(tile_col + 2, tile_cols)):
            now = wp.max(now, wp.max(wet[a * tile_cols + b], forced[a * tile_cols + b]))
    if now == 1:
        tiles[wp.atomic_add(tile_count, 0, 1)] = tile
    elif active[tile] == 1:
        row0 = tile_row * SIDE + 2
        col0 = tile_col * SIDE + 2
        for i in range(row0, wp.min(row0 + SIDE, nrows + 2)):
            for j in range(col0, wp.min(col0 + SIDE, ncols + 2)):
                h_out[i, j] = h[i, j]
                u_out[i, j] = u[i, j]
                v_out[i, j] = v[i, j]
    active[tile] = now
