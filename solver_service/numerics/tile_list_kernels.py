"""The list of active tiles, made by thread blocks: the rule of `tile_kernels` at the speed of a GPU.

    scan    a block looks at all cells of a tile at once: lively quadrants, wave speed. Only the tiles of the
            last list are looked at, since no other can have changed; all of them when an interval begins
    list    a thread per tile asks the quadrants around it and appends the tile

The array of the list holds the tiles to step from its beginning, and from its end those that fall asleep:
the next step copies them, so that both buffers hold their state. The order of the list is not fixed, and
nothing depends on it. The tests prove these lists equal to those of `tile_kernels`.
"""

import warp as wp

from solver_service.numerics.clock_kernels import (
    CLOCK_TARGET,
    CLOCK_TIME,
    COUNT_FAILED,
    COUNT_LIMIT,
    COUNT_STEPS,
)
from solver_service.numerics.friction import GRAVITY
from solver_service.numerics.tile_kernels import column_quadrants, near_bits
from solver_service.numerics.tile_step_kernels import ASLEEP, LANES, LISTED, lane_count, never
from solver_service.numerics.warp_modules import STEP_MODULE

LISTED_BEFORE = wp.constant(2)
"""Place of the number of tiles of the last list in `tile_count`."""


@wp.func
def wave_speed(h: float, u: float, v: float) -> float:
    """Largest speed of a wave along x or y [m/s]."""
    return wp.max(wp.abs(u), wp.abs(v)) + wp.sqrt(GRAVITY * h)


_SCAN = r"""
#if defined(__CUDA_ARCH__)
    __shared__ int tile_words[5];
    volatile int* const words = tile_words;
#else
    volatile int* const words = (int*)host_memory.data;
#endif
    const int lane = WP_TILE_THREAD_IDX;
    const int lanes = WP_TILE_BLOCK_DIM;
    __builtin_assume(lane >= 0 && lane < lanes);
    for (int k = lane; k < 5; k += lanes) words[k] = 0;
    WP_TILE_SYNC();
    const int pitch = ncols + 4;
    int highest = 0;
    for (int k = lane; k < 256; k += lanes) {
        const int r = k / 16, c = k % 16;
        const int row = (tile / tile_cols) * 16 + r, col = (tile % tile_cols) * 16 + c;
        if (row >= nrows || col >= ncols) continue;
        const size_t at = (size_t)(row + 2) * pitch + (col + 2);
        const float depth = ((const float*)h.data)[at];
        const float x = ((const float*)u.data)[at], y = ((const float*)v.data)[at];
        if (depth > depth_film && (first == 1 || is_wet_lively == 1 || x != 0.0f || y != 0.0f
                || depth != ((const float*)h_before.data)[at]))
            words[2 * (r / 8) + c / 8] = 1;
        const float wave = WAVE(depth, x, y);
        const int bits = *(const int*)&wave;
        highest = highest < bits ? bits : highest;
    }
#if defined(__CUDA_ARCH__)
    atomicMax((int*)words + 4, highest);
#else
    words[4] = words[4] < highest ? highest : words[4];
#endif
    WP_TILE_SYNC();
    if (lane == 0) {
        const int found = words[0] | words[1] << 1 | words[2] << 2 | words[3] << 3 | (forced_tile ? 15 : 0);
        ((int*)quadrants.data)[tile] = found;
        ((int*)tile_wave.data)[tile] = first == 1 && found == 0 ? 0 : words[4];
    }
    WP_TILE_SYNC();
"""


@wp.func_native(_SCAN.replace("WAVE(", wave_speed.native_func + "("))
def scan_tile(
    h: wp.array2d(dtype=wp.float32),
    u: wp.array2d(dtype=wp.float32),
    v: wp.array2d(dtype=wp.float32),
    h_before: wp.array2d(dtype=wp.float32),
    depth_film: float,
    first: int,
    is_wet_lively: int,
    nrows: int,
    ncols: int,
    tile: int,
    tile_cols: int,
    forced_tile: int,
    host_memory: wp.array(dtype=wp.float32),
    quadrants: wp.array(dtype=wp.int32),
    tile_wave: wp.array(dtype=wp.float32),
):
    """Lively quadrants and largest wave speed of one tile, with all lanes of the block."""
    ...


_APPEND = r"""
    int* const number = (int*)tile_count.data + kind;
#if defined(__CUDA_ARCH__)
    // One atomic for all threads of the warp that are here.
    const unsigned here = __activemask();
    const int thread = threadIdx.x % 32, leader = __ffs(here) - 1;
    int place = 0;
    if (thread == leader) place = atomicAdd(number, __popc(here));
    place = __shfl_sync(here, place, leader) + __popc(here & ((1u << thread) - 1u));
#else
    const int place = (*number)++;
#endif
    ((int*)tiles.data)[kind == 0 ? place : tiles.shape[0] - 1 - place] = tile;
"""


@wp.func_native(_APPEND)
def append_tile(tile: int, kind: int, tiles: wp.array(dtype=wp.int32), tile_count: wp.array(dtype=wp.int32)):
    """List a tile; `kind` is `LISTED` or `ASLEEP`."""
    ...


@wp.kernel(module=STEP_MODULE, launch_bounds=LANES, grid_stride=False)
def scan_tiles(
    h: wp.array2d(dtype=wp.float32),
    u: wp.array2d(dtype=wp.float32),
    v: wp.array2d(dtype=wp.float32),
    h_before: wp.array2d(dtype=wp.float32),
    depth_film: float,
    is_wet_lively: int,
    nrows: int,
    ncols: int,
    tile_rows: int,
    tile_cols: int,
    tiles: wp.array(dtype=wp.int32),
    tile_count: wp.array(dtype=wp.int32),
    forced: wp.array(dtype=wp.int32),
    is_first: wp.array(dtype=wp.int32),
    blocks: int,
    host_memory: wp.array(dtype=wp.float32),
    # outputs
    quadrants: wp.array(dtype=wp.int32),
    tile_wave: wp.array(dtype=wp.float32),
):
    """Look at the tiles of the last list, or at all of them when an interval begins; see `classify_tiles`.

    Args:
        h: depth [m], padded.
        u: velocity [m/s], padded.
        v: velocity [m/s], padded.
        h_before: depth a step ago [m], padded.
        depth_film: depth that does not move by itself [m].
        is_wet_lively: 1 where water deeper than that never sleeps.
        nrows: grid rows.
        ncols: grid columns.
        tile_rows: tiles in a column of tiles.
        tile_cols: tiles in a row of tiles.
        tiles: the last list.
        tile_count: [3], see `LISTED`, `ASLEEP`, `LISTED_BEFORE`.
        forced: 1 for tiles that may get water from outside.
        is_first: [2], the second is 1 for the first list of an interval.
        blocks: number of blocks of the launch.
        host_memory: memory of a block on the CPU.
        quadrants: quadrant bits of each tile.
        tile_wave: largest wave speed of each tile [m/s].
    """
    if never():  # tells Warp to generate the function that the native code calls
        tile_wave[0] = wave_speed(0.0, 0.0, 0.0)
    first = is_first[1]
    count = wp.where(first == 1, tile_rows * tile_cols, tile_count[LISTED_BEFORE])
    k = wp.tid() // lane_count()
    while k < count:
        tile = int(k)
        if first == 0:
            tile = tiles[k]
        scan_tile(
            h, u, v, h_before, depth_film, first, is_wet_lively, nrows, ncols, tile, tile_cols, forced[tile],
            host_memory, quadrants, tile_wave,
        )  # fmt: skip
        k += blocks


@wp.kernel(module=STEP_MODULE)
def list_tiles(
    quadrants: wp.array(dtype=wp.int32),
    tile_wave: wp.array(dtype=wp.float32),
    is_first: wp.array(dtype=wp.int32),
    tile_rows: int,
    tile_cols: int,
    # outputs
    active: wp.array(dtype=wp.int32),
    tiles: wp.array(dtype=wp.int32),
    tile_count: wp.array(dtype=wp.int32),
    rest_wave: wp.array(dtype=wp.float32),
):
    """List the tiles to step, and those that fall asleep; see `list_active_tiles`."""
    tile = wp.tid()
    r = tile // tile_cols
    c = tile % tile_cols
    near = near_bits(
        column_quadrants(quadrants, r, c - 1, tile_rows, tile_cols),
        column_quadrants(quadrants, r, c, tile_rows, tile_cols),
        column_quadrants(quadrants, r, c + 1, tile_rows, tile_cols),
    )
    was_active = active[tile]
    wave = tile_wave[tile]
    slot = wp.where(near == 0, 0, 1)
    if (near == 0 or is_first[1] == 1 or was_active == 0) and wave > rest_wave[slot]:
        wp.atomic_max(rest_wave, slot, wave)
    if near != 0:
        append_tile(tile, LISTED, tiles, tile_count)
        active[tile] = 1
    elif was_active == 1:
        append_tile(tile, ASLEEP, tiles, tile_count)
        active[tile] = 0


@wp.kernel(module=STEP_MODULE)
def decide_and_begin_list(
    clock: wp.array(dtype=wp.float64),
    counts: wp.array(dtype=wp.int32),
    # outputs
    go_on: wp.array(dtype=wp.int32),
    is_first: wp.array(dtype=wp.int32),
    tile_count: wp.array(dtype=wp.int32),
    rest_wave: wp.array(dtype=wp.float32),
):
    """As `decide_to_go_on`; when more steps follow, also get ready for their list."""
    more = clock[CLOCK_TIME] < clock[CLOCK_TARGET] and counts[COUNT_FAILED] == 0
    go_on[0] = 0
    if more and counts[COUNT_STEPS] < counts[COUNT_LIMIT]:
        go_on[0] = 1
        is_first[1] = is_first[0]
        is_first[0] = 0
        tile_count[LISTED_BEFORE] = tile_count[LISTED]
        tile_count[LISTED] = 0
        tile_count[ASLEEP] = 0
        rest_wave[0] = 0.0
        rest_wave[1] = 0.0
