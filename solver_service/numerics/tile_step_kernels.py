"""The step of CUDA devices: a thread block takes one active tile from one state to the next.

Every value is computed once and handed over in shared memory:

    load      h u v z drag of the tile with two cells around it, 16 bytes at a time
    predict   the cells of the tile with one cell around it
    faces     the 17 x 16 faces along x, then the 16 x 17 along y, each once
    update    the cells of the tile, maxima, wave speed

Each phase is a loop `for (k = lane; k < N; k += lanes)`, with a barrier between the phases, over the same
generated functions as in every other engine; within a phase no turn of the loop reads what another writes.
So the number of lanes does not show in the result: a GPU runs 256 lanes, a CPU one (Warp's `block_dim`),
and the tests prove that source equal to the cell-by-cell kernel bit for bit. In a tile without
any water nothing moves: of it only the maxima are visited.

Blocks walk over the list of tiles with a fixed stride, so that the launch, hence the captured graph, does
not depend on how many tiles are active. Maxima are order-free and nothing is summed: runs repeat bit for
bit.
"""

import warp as wp

from solver_service.numerics.clock_kernels import CLOCK_DT, CLOCK_STABLE, CLOCK_TIME
from solver_service.numerics.conservative_update import film_speed, update_cell, widen_maxima
from solver_service.numerics.fields import Fields, Scheme
from solver_service.numerics.reconstruction import predict
from solver_service.numerics.riemann import face_flux
from solver_service.numerics.step_kernels import step_cell
from solver_service.numerics.warp_modules import STEP_MODULE

LANES = 256
"""Threads of a block: one per cell of a tile."""

BLOCKS_PER_MULTIPROCESSOR = 4
"""Blocks that shall fit on a multiprocessor at once: at most 64 registers a thread."""

LISTED = wp.constant(0)
"""Place of the number of tiles to step in `tile_count`."""
ASLEEP = wp.constant(1)
"""Place of the number of tiles that have fallen asleep."""

SHARED_FLOATS = 5 * 400 + 14 * 324 + 4 * 544
"""Floats in shared memory: loaded cells, predictions, fluxes."""

SHARED_WORDS = 2
"""Integers in shared memory: whether there is water, largest wave speed."""

HOST_MEMORY = SHARED_FLOATS + SHARED_WORDS
"""What stands for shared memory on a CPU [4 bytes]."""

_SHARED = r"""
#if defined(__CUDA_ARCH__)
    __shared__ alignas(16) float tile_floats[FLOATS];
    __shared__ int tile_words[WORDS];
    float* const shared = tile_floats;
    volatile int* const words = tile_words;
#else
    float* const shared = (float*)host_memory.data;
    volatile int* const words = (int*)(shared + FLOATS);
#endif
    const int lane = WP_TILE_THREAD_IDX;
    const int lanes = WP_TILE_BLOCK_DIM;
    __builtin_assume(lane >= 0 && lane < lanes);
    const int pitch = s.ncols + 4;
    const int row0 = (tile / tile_cols) * 16, col0 = (tile % tile_cols) * 16;
"""

STEP_SOURCE = (
    _SHARED
    + r"""
    float* const H = shared;
    float* const U = shared + 400;
    float* const V = shared + 800;
    float* const Z = shared + 1200;
    float* const D = shared + 1600;
    float* const P = shared + 2000;
    float* const X = shared + 2000 + 14 * 324;
    float* const Y = X + 4 * 272;
    for (int k = lane; k < WORDS; k += lanes) words[k] = 0;
    WP_TILE_SYNC();

    // load: index (r, c) of 20 x 20 is padded cell (row0 + r, col0 + c)
    const float* const from[] = {(const float*)f.h.data, (const float*)f.u.data, (const float*)f.v.data,
        (const float*)f.z.data, (const float*)f.drag.data};
    struct alignas(16) quad { float x, y, z, w; };
    if (pitch % 4 == 0) {
        for (int k = lane; k < 100; k += lanes) {
            const int r = k / 5, c = 4 * (k % 5);
            const bool inside = row0 + r < s.nrows + 4 && col0 + c < pitch;
            const size_t at = (size_t)(row0 + r) * pitch + (col0 + c);
            quad four[5];
            UNROLL for (int m = 0; m < 5; ++m) {
                four[m] = quad{0.0f, 0.0f, 0.0f, 0.0f};
                if (inside) four[m] = *(const quad*)(from[m] + at);
            }
            UNROLL for (int m = 0; m < 5; ++m) *(quad*)(shared + 400 * m + 20 * r + c) = four[m];
            if (four[0].x > 0.0f || four[0].y > 0.0f || four[0].z > 0.0f || four[0].w > 0.0f) words[0] = 1;
        }
    } else {
        for (int k = lane; k < 400; k += lanes) {
            const int r = k / 20, c = k % 20;
            const bool inside = row0 + r < s.nrows + 4 && col0 + c < pitch;
            const size_t at = (size_t)(row0 + r) * pitch + (col0 + c);
            float one[5];
            UNROLL for (int m = 0; m < 5; ++m) one[m] = inside ? from[m][at] : 0.0f;
            UNROLL for (int m = 0; m < 5; ++m) shared[400 * m + k] = one[m];
            if (one[0] > 0.0f) words[0] = 1;
        }
    }
    WP_TILE_SYNC();
    const bool wet = words[0] != 0;

    // predict: index (r, c) of 18 x 18 is padded cell (row0 + 1 + r, col0 + 1 + c); corners are not needed
    if (wet)
        for (int k = lane; k < 320; k += lanes) {
            const int t = k < 288 ? k + 18 : k < 304 ? k - 287 : k + 3;
            const int o = (t / 18 + 1) * 20 + (t % 18 + 1);
            auto p = PREDICT(H[o], U[o], V[o], Z[o], H[o-1], U[o-1], V[o-1], Z[o-1],
                H[o+1], U[o+1], V[o+1], Z[o+1], H[o-20], U[o-20], V[o-20], Z[o-20],
                H[o+20], U[o+20], V[o+20], Z[o+20],
                D[o], 0.5f * dt, s.dx, s.theta, s.depth_dry, s.depth_film, s.hancock, s.eddy);
            UNROLL for (int m = 0; m < 14; ++m) P[324 * m + t] = p[m];
        }
    WP_TILE_SYNC();

    // faces along x: the western one of each cell, then the eastern edge of the tile; along y alike
    const float dt_dx = dt / s.dx;
    if (wet) {
        NO_UNROLL for (int k = lane; k < 272; k += lanes) {
            const int r = k < 256 ? k / 16 : k - 256, c = k < 256 ? k % 16 : 16;
            const float* const L = P + 18 * (r + 1) + c;
            const float* const R = L + 1;
            const int o = 20 * (r + 2) + (c + 1);
            auto q = FACE(L[0], L[3*324], L[1*324], L[4*324], L[2*324], L[5*324], L[6*324],
                L[11*324], L[12*324], L[13*324],
                R[0], R[3*324], R[1*324], R[4*324], R[2*324], R[5*324], R[6*324],
                R[11*324], R[12*324], R[13*324],
                Z[o + 1] - Z[o], dt_dx, s.contact);
            UNROLL for (int m = 0; m < 4; ++m) X[272 * m + k] = q[m];
        }
        NO_UNROLL for (int k = lane; k < 272; k += lanes) {
            const int r = k / 16, c = k % 16;
            const float* const L = P + 18 * r + (c + 1);
            const float* const R = L + 18;
            const int o = 20 * (r + 1) + (c + 2);
            auto q = FACE(L[0], L[7*324], L[2*324], L[9*324], L[1*324], L[8*324], L[10*324],
                L[11*324], L[12*324], L[13*324],
                R[0], R[7*324], R[2*324], R[9*324], R[1*324], R[8*324], R[10*324],
                R[11*324], R[12*324], R[13*324],
                Z[o + 20] - Z[o], dt_dx, s.contact);
            UNROLL for (int m = 0; m < 4; ++m) Y[272 * m + k] = q[m];
        }
    }
    WP_TILE_SYNC();

    // update
    const float film_speed = FILM_SPEED(s.courant, s.depth_cfl, stable);
    int highest = 0;
    for (int k = lane; k < 256; k += lanes) {
        const int r = k / 16, c = k % 16;
        const int row = row0 + r, col = col0 + c;
        if (row >= s.nrows || col >= s.ncols) continue;
        const int o = 20 * (r + 2) + (c + 2);
        wp::vec_t<4, float> q(H[o], U[o], V[o], 0.0f);
        if (wet) {
            const float* const C = P + 18 * (r + 1) + (c + 1);
            const float* const W = X + k;
            const float* const E = c < 15 ? W + 1 : X + 256 + r;
            const float* const S = Y + k;
            const float* const N = S + 16;
            q = UPDATE(H[o], U[o], V[o], C[0], C[3*324] + C[6*324], C[7*324] + C[10*324],
                E[0], E[272], E[3*272], W[0], W[2*272], W[3*272],
                N[0], N[272], N[3*272], S[0], S[2*272], S[3*272], D[o], dt, s.dx, s.depth_dry,
                s.depth_cfl, film_speed);
            double* const edge = (double*)f.edge_flow.data;
            const int edge_pitch = f.edge_flow.shape[1];
            if (col == 0) edge[row] -= (double)W[0];
            if (col == s.ncols - 1) edge[edge_pitch + row] += (double)E[0];
            if (row == 0) edge[2 * edge_pitch + col] -= (double)S[0];
            if (row == s.nrows - 1) edge[3 * edge_pitch + col] += (double)N[0];
        }
        const size_t at = (size_t)(row + 2) * pitch + (col + 2);
        ((float*)f.h_out.data)[at] = q[0];
        ((float*)f.u_out.data)[at] = q[1];
        ((float*)f.v_out.data)[at] = q[2];
        float* const kept[] = {(float*)f.h_max.data, (float*)f.h_max_time.data, (float*)f.speed_max.data,
            (float*)f.discharge_max.data, (float*)f.hazard_max.data, (float*)f.arrival.data,
            (float*)f.wet_since.data, (float*)f.rise_rate_max.data};
        float old[8];
        UNROLL for (int m = 0; m < 8; ++m) old[m] = kept[m][at];
        auto w = WIDEN(q[0], q[1], q[2], q[3], H[o], dt, time, s.depth_arrival,
            old[0], old[1], old[2], old[3], old[4], old[5], old[6], old[7]);
        // Most steps widen few maxima: what is not written costs no memory traffic.
        UNROLL for (int m = 0; m < 8; ++m) {
            const float widened = w[m < 6 ? m : m + 1];
            if (widened != old[m]) kept[m][at] = widened;
        }
        const float wave = w[6];
        // Waves are not negative: their bits are ordered as they are.
        const int bits = *(const int*)&wave;
        highest = highest < bits ? bits : highest;
    }
#if defined(__CUDA_ARCH__)
#if __CUDA_ARCH__ >= 800
    highest = __reduce_max_sync(0xffffffffu, highest);
    if (lane % 32 == 0)
#endif
        atomicMax((int*)words + 1, highest);
#else
    words[1] = words[1] < highest ? highest : words[1];
#endif
    WP_TILE_SYNC();
    if (lane == 0) {
        const int found = words[1];
        int* const slot = (int*)wave_slots.data + tile % wave_slots.shape[0];
#if defined(__CUDA_ARCH__)
        atomicMax(slot, found);
#else
        *slot = *slot < found ? found : *slot;
#endif
    }
    WP_TILE_SYNC();
"""
)

_COPY = r"""
    const int lane = WP_TILE_THREAD_IDX;
    const int lanes = WP_TILE_BLOCK_DIM;
    __builtin_assume(lane >= 0 && lane < lanes);
    const int pitch = s.ncols + 4;
    for (int k = lane; k < 256; k += lanes) {
        const int row = (tile / tile_cols) * 16 + k / 16, col = (tile % tile_cols) * 16 + k % 16;
        if (row >= s.nrows || col >= s.ncols) continue;
        const size_t at = (size_t)(row + 2) * pitch + (col + 2);
        ((float*)f.h_out.data)[at] = ((const float*)f.h.data)[at];
        ((float*)f.u_out.data)[at] = ((const float*)f.u.data)[at];
        ((float*)f.v_out.data)[at] = ((const float*)f.v.data)[at];
    }
"""


def with_names(snippet: str) -> str:
    """Native source with the names that Warp gave to the functions it generates."""
    names = {"PREDICT": predict, "FACE": face_flux, "UPDATE": update_cell, "WIDEN": widen_maxima}
    names["FILM_SPEED"] = film_speed
    for word, function in names.items():
        snippet = snippet.replace(word + "(", function.native_func + "(")
    return (
        snippet.replace("NO_UNROLL", '_Pragma("unroll 1")')
        .replace("UNROLL", '_Pragma("unroll")')
        .replace("FLOATS", str(SHARED_FLOATS))
        .replace("WORDS", str(SHARED_WORDS))
    )


@wp.func_native(with_names(STEP_SOURCE))
def step_tile(
    f: Fields,
    s: Scheme,
    tile: int,
    tile_cols: int,
    dt: float,
    stable: float,
    time: float,
    host_memory: wp.array(dtype=wp.float32),
    wave_slots: wp.array(dtype=wp.float32),
):
    """Step one tile with all lanes of the block."""
    ...


@wp.func_native(_COPY)
def copy_tile(f: Fields, s: Scheme, tile: int, tile_cols: int):
    """Copy the state of one tile with all lanes of the block."""
    ...


@wp.func_native("return WP_TILE_BLOCK_DIM;")
def lane_count() -> int:
    """Threads of a block."""
    ...


@wp.func_native("return false;")
def never() -> bool:
    """False, but Warp does not know."""
    ...


@wp.kernel(module=STEP_MODULE, launch_bounds=(LANES, BLOCKS_PER_MULTIPROCESSOR), grid_stride=False)
def step_listed_tiles(
    f: Fields,
    s: Scheme,
    clock: wp.array(dtype=wp.float64),
    tiles: wp.array(dtype=wp.int32),
    tile_count: wp.array(dtype=wp.int32),
    tile_cols: int,
    blocks: int,
    host_memory: wp.array(dtype=wp.float32),
    # outputs
    wave_slots: wp.array(dtype=wp.float32),
):
    """Advance the listed tiles by the clock's dt, copy those asleep; with dt = 0 copy all.

    Args:
        f: rasters.
        s: scheme.
        clock: see `clock_kernels`.
        tiles: row-major numbers of the tiles to step, from the end those that have fallen asleep.
        tile_count: how many; see `LISTED`, `ASLEEP`.
        tile_cols: tiles in a row of tiles.
        blocks: number of blocks; the launch has that many times the lanes of a block.
        host_memory: memory of a block on the CPU, [HOST_MEMORY].
        wave_slots: largest wave speed seen [m/s], any slot.
    """
    block = wp.tid() // lane_count()
    dt = wp.float32(clock[CLOCK_DT])
    stable = wp.float32(clock[CLOCK_STABLE])
    time = wp.float32(clock[CLOCK_TIME])
    if never():  # tells Warp to generate the functions that the native code calls
        step_cell(f, s, 2, 2, dt, stable, time)
    listed = tile_count[LISTED]
    count = listed + tile_count[ASLEEP]
    k = int(block)
    while k < count:
        if k < listed and dt > 0.0:
            step_tile(f, s, tiles[k], tile_cols, dt, stable, time, host_memory, wave_slots)
        else:
            place = wp.where(k < listed, k, tiles.shape[0] - 1 - (k - listed))
            copy_tile(f, s, tiles[place], tile_cols)
        k += blocks
