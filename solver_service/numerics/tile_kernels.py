"""Which compute tiles can change in the next steps: where something happens, and what lies close to it.

A cell is lively when it moves, or when its depth changed in the last step. What it does reaches two cells
further with every step (slopes, then fluxes); a list that is renewed every `REFRESH_STEPS` = 4 steps must
therefore hold every cell within 8 cells of a lively one. That is half a tile: each tile says in which of
its quadrants it is lively, and a lively quadrant wakes the tiles that touch it. Dry land sleeps, and so
does a lake at rest.

The first list of an interval takes every cell deeper than the film for lively, so that what is computed
depends on the state alone and not on how it came to be. Water no deeper than `depth_film` does not move by
itself.

A tile's wave speed is kept while it sleeps and counts for the time step until it has been computed once
after waking.

These kernels take a row of tiles per thread, as suits CPUs; `tile_list_kernels` makes the same lists on
GPUs.
"""

import warp as wp

from solver_service.numerics.friction import GRAVITY
from solver_service.numerics.warp_modules import SUPPORT_MODULE

SIDE = wp.constant(16)
HALF = wp.constant(8)
EVERY_QUADRANT = wp.constant(15)
"""Quadrant bits: 1 south-west, 2 south-east, 4 north-west, 8 north-east."""


@wp.kernel(module=SUPPORT_MODULE)
def classify_tiles(
    h: wp.array2d(dtype=wp.float32),
    u: wp.array2d(dtype=wp.float32),
    v: wp.array2d(dtype=wp.float32),
    h_before: wp.array2d(dtype=wp.float32),
    depth_film: float,
    is_wet_lively: int,
    nrows: int,
    ncols: int,
    tile_cols: int,
    active: wp.array(dtype=wp.int32),
    forced: wp.array(dtype=wp.int32),
    is_first: wp.array(dtype=wp.int32),
    # outputs
    quadrants: wp.array(dtype=wp.int32),
    tile_count: wp.array(dtype=wp.int32),
    rest_wave: wp.array(dtype=wp.float32),
):
    """Set the lively quadrants of each tile; a tile that sleeps has none, but in the first list.

    Args:
        h: depth [m], padded.
        u: velocity [m/s], padded.
        v: velocity [m/s], padded.
        h_before: depth a step ago [m], padded.
        depth_film: depth that does not move by itself [m].
        is_wet_lively: 1 where water deeper than that never sleeps.
        nrows: grid rows.
        ncols: grid columns.
        tile_cols: tiles in a row of tiles.
        active: tiles of the last list.
        forced: 1 for tiles that may get water from outside.
        is_first: [2], the first is 1 for the first list of an interval; copied to the second.
        quadrants: quadrant bits of each tile.
        tile_count: [1], set to zero.
        rest_wave: [2], set to zero.
    """
    r = wp.tid()
    if r == 0:
        tile_count[0] = 0
        rest_wave[0] = 0.0
        rest_wave[1] = 0.0
        is_first[1] = is_first[0]
    first = is_first[0]
    wet = wp.max(first, is_wet_lively)
    for tile in range(r * tile_cols, (r + 1) * tile_cols):
        found = int(0)
        if forced[tile] == 1:
            found = EVERY_QUADRANT
        elif active[tile] == 1 or first == 1:
            for quadrant in range(4):
                i0 = r * SIDE + (quadrant // 2) * HALF + 2
                j0 = (tile - r * tile_cols) * SIDE + (quadrant % 2) * HALF + 2
                i1 = wp.min(i0 + HALF, nrows + 2)
                j1 = wp.min(j0 + HALF, ncols + 2)
                lively = int(0)
                i = int(i0)
                while i < i1 and lively == 0:
                    j = int(j0)
                    while j < j1 and lively == 0:
                        if h[i, j] > depth_film:
                            if wet == 1 or u[i, j] != 0.0 or v[i, j] != 0.0 or h[i, j] != h_before[i, j]:
                                lively = 1
                        j += 1
                    i += 1
                if lively == 1:
                    found = found | (1 << quadrant)
        quadrants[tile] = found


@wp.func
def quadrants_at(
    quadrants: wp.array(dtype=wp.int32), tile_row: int, tile_col: int, tile_rows: int, tile_cols: int
) -> int:
    """Quadrant bits of a tile, none off the grid."""
    found = int(0)
    if tile_row >= 0 and tile_row < tile_rows and tile_col >= 0 and tile_col < tile_cols:
        found = quadrants[tile_row * tile_cols + tile_col]
    return found


@wp.func
def column_quadrants(
    quadrants: wp.array(dtype=wp.int32), r: int, c: int, tile_rows: int, tile_cols: int
) -> int:
    """Quadrant bits of tile (r, c), above them those of its northern, then of its southern neighbour."""
    own = quadrants_at(quadrants, r, c, tile_rows, tile_cols)
    north = quadrants_at(quadrants, r + 1, c, tile_rows, tile_cols)
    south = quadrants_at(quadrants, r - 1, c, tile_rows, tile_cols)
    return own | (north << 4) | (south << 8)


@wp.func
def near_bits(west: int, here: int, east: int) -> int:
    """Bits of the lively quadrants that a tile holds or touches; 0 where it may sleep.

    Arguments are the `column_quadrants` of the tile and of its western and eastern neighbour.
    """
    own = (here & 15) | (west & 10) | (east & 5)
    north = (here & 0x30) | (west & 0x20) | (east & 0x10)
    south = (here & 0xC00) | (west & 0x800) | (east & 0x400)
    return own | north | south


@wp.kernel(module=SUPPORT_MODULE)
def list_active_tiles(
    h: wp.array2d(dtype=wp.float32),
    u: wp.array2d(dtype=wp.float32),
    v: wp.array2d(dtype=wp.float32),
    quadrants: wp.array(dtype=wp.int32),
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
    is_first: wp.array(dtype=wp.int32),
    tile_wave: wp.array(dtype=wp.float32),
    rest_wave: wp.array(dtype=wp.float32),
):
    """List the tiles to compute; a tile that falls asleep gets the same state in both buffers.

    `rest_wave` gets the largest wave speed [m/s] of the tiles that sleep, and of those that wake now.
    """
    r = wp.tid()
    first = is_first[1]
    rest = float(0.0)
    waking = float(0.0)
    west = int(0)
    here = column_quadrants(quadrants, r, 0, tile_rows, tile_cols)
    for c in range(tile_cols):
        east = column_quadrants(quadrants, r, c + 1, tile_rows, tile_cols)
        near = near_bits(west, here, east)
        own = here & EVERY_QUADRANT
        west = here
        here = east
        tile = r * tile_cols + c
        was_active = active[tile]
        if first == 1:
            tile_wave[tile] = 0.0
        if (first == 1 and own != 0) or (near == 0 and was_active == 1):
            row0 = r * SIDE + 2
            col0 = c * SIDE + 2
            wave = float(0.0)
            for i in range(row0, wp.min(row0 + SIDE, nrows + 2)):
                for j in range(col0, wp.min(col0 + SIDE, ncols + 2)):
                    fastest = wp.max(wp.abs(u[i, j]), wp.abs(v[i, j]))
                    wave = wp.max(wave, fastest + wp.sqrt(GRAVITY * h[i, j]))
                    if near == 0 and was_active == 1:
                        h_out[i, j] = h[i, j]
                        u_out[i, j] = u[i, j]
                        v_out[i, j] = v[i, j]
            # In the first list a film counts for nothing, asleep or not: nothing may depend on the past.
            if first == 0 or own != 0:
                tile_wave[tile] = wave
        if near != 0:
            if first == 1 or was_active == 0:
                waking = wp.max(waking, tile_wave[tile])
            tiles[wp.atomic_add(tile_count, 0, 1)] = tile
            active[tile] = 1
        else:
            rest = wp.max(rest, tile_wave[tile])
            active[tile] = 0
    wp.atomic_max(rest_wave, 0, rest)
    wp.atomic_max(rest_wave, 1, waking)
    if r == 0:
        is_first[0] = 0
