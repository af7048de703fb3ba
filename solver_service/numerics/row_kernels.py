"""The step of CPUs: row loops that clang turns into SIMD, around the same mathematics as every other engine.

Warp compiles its launch loop as scalar code. Here a native loop over a row calls the C++ functions that Warp
generates from `predict`, `face_flux`, `update_cell` and `widen_maxima`; they have no branches, so the loop
vectorises. A chunk of cells is swept from south to north with everything in between kept in cache:

    predict row i              -> ring of two rows of predictions
    faces between i - 1 and i  -> ring of two rows of fluxes
    faces within row i - 1     -> one row of fluxes
    update row i - 1           -> new state, maxima, wave speed

Chunks are independent: they read one state and write the other, and recompute the faces on their border to
the same bits. This module is for CPUs only; NVRTC never sees it. Names of generated functions are asked of
Warp.
"""

import warp as wp

from solver_service.numerics.conservative_update import (
    arrival_time,
    film_speed,
    update_cell,
    widen_maxima,
)
from solver_service.numerics.fields import Fields, Scheme
from solver_service.numerics.reconstruction import predict
from solver_service.numerics.riemann import face_flux
from solver_service.numerics.warp_modules import ROWS_MODULE

CHUNK_COLS = 2048
"""Widest chunk [cells]: its rows stay in the cache next to the core."""

NARROW_COLS = 256
"""Chunks up to this wide fetch the rows ahead themselves [cells]."""

SCRATCH_ROWS = 46
"""Rows of scratch memory per thread."""

_SWEEP = r"""
    const int pitch = s.ncols + 4;
    const int span = scratch_pitch;
    const float* __restrict__ h = (const float*)f.h.data;
    const float* __restrict__ u = (const float*)f.u.data;
    const float* __restrict__ v = (const float*)f.v.data;
    const float* __restrict__ z = (const float*)f.z.data;
    const float* __restrict__ drag = (const float*)f.drag.data;
    const float half_dt = 0.5f * dt;
    const float dx = s.dx, theta = s.theta, hancock = s.hancock, contact = s.contact, eddy = s.eddy;
    const float depth_dry = s.depth_dry, depth_film = s.depth_film, depth_arrival = s.depth_arrival;
    const float depth_cfl = s.depth_cfl, film_speed = FILM_SPEED(s.courant, depth_cfl, stable);
    const float r = dt / dx;
    double* edge = (double*)f.edge_flow.data;
    const int edge_pitch = f.edge_flow.shape[1];

    const int row0 = chunks[4 * chunk] + 2, row1 = chunks[4 * chunk + 1] + 2;
    const int col0 = chunks[4 * chunk + 2] + 2, count = chunks[4 * chunk + 3] - chunks[4 * chunk + 2];
    // Scratch rows begin one cell west of the chunk: index j is padded column col0 - 1 + j.
    float* __restrict__ scratch = (float*)scratch_array.data + (size_t)scratch_offset;
    float* __restrict__ waves = scratch + (size_t)40 * span;
    float* __restrict__ speeds = scratch + (size_t)41 * span;
    for (int j = 0; j < count; ++j) waves[j] = 0.0f;
    const bool narrow = count <= NARROW;
    const float* const written[] = {
        (const float*)f.h_out.data, (const float*)f.u_out.data, (const float*)f.v_out.data,
        (const float*)f.h_max.data, (const float*)f.h_max_time.data, (const float*)f.speed_max.data,
        (const float*)f.discharge_max.data, (const float*)f.hazard_max.data, (const float*)f.arrival.data,
        (const float*)f.wet_since.data, (const float*)f.rise_rate_max.data};

    for (int i = row0 - 1; i <= row1; ++i) {
        float* __restrict__ B = scratch + (size_t)((i & 1) * 14) * span;
        const float* __restrict__ A = scratch + (size_t)(((i - 1) & 1) * 14) * span;
        const size_t at = (size_t)i * pitch + (col0 - 1);
        const float* __restrict__ hc = h + at; const float* __restrict__ uc = u + at;
        const float* __restrict__ vc = v + at; const float* __restrict__ zc = z + at;
        const float* __restrict__ hs = hc - pitch; const float* __restrict__ us = uc - pitch;
        const float* __restrict__ vs = vc - pitch; const float* __restrict__ zs = zc - pitch;
        const float* __restrict__ hn = hc + pitch; const float* __restrict__ un = uc + pitch;
        const float* __restrict__ vn = vc + pitch; const float* __restrict__ zn = zc + pitch;
        const float* __restrict__ kc = drag + at;
        // Rows of a narrow chunk lie on pages of their own: the hardware does not see the next one coming.
        for (int j = 0; j < count + 2 && narrow && i < s.nrows + 2; j += 16) {
            const size_t ahead = 2 * (size_t)pitch + j;
            __builtin_prefetch(hc + ahead); __builtin_prefetch(uc + ahead);
            __builtin_prefetch(vc + ahead); __builtin_prefetch(zc + ahead);
            __builtin_prefetch(kc + pitch + j);
            for (const float* field : written) __builtin_prefetch(field + at + j, 1);
        }
        #pragma clang loop vectorize(assume_safety) vectorize_width(16)
        for (int j = 0; j < count + 2; ++j) {
            auto p = PREDICT(hc[j], uc[j], vc[j], zc[j], hc[j-1], uc[j-1], vc[j-1], zc[j-1],
                hc[j+1], uc[j+1], vc[j+1], zc[j+1], hs[j], us[j], vs[j], zs[j], hn[j], un[j], vn[j], zn[j],
                kc[j], half_dt, dx, theta, depth_dry, depth_film, hancock, eddy);
            B[j] = p[0]; B[span+j] = p[1]; B[2*span+j] = p[2]; B[3*span+j] = p[3]; B[4*span+j] = p[4];
            B[5*span+j] = p[5]; B[6*span+j] = p[6]; B[7*span+j] = p[7]; B[8*span+j] = p[8];
            B[9*span+j] = p[9]; B[10*span+j] = p[10]; B[11*span+j] = p[11]; B[12*span+j] = p[12];
            B[13*span+j] = p[13];
        }
        if (i == row0 - 1) continue;

        float* __restrict__ N = scratch + (size_t)(28 + (i & 1) * 4) * span;
        #pragma clang loop vectorize(assume_safety) vectorize_width(16)
        for (int j = 1; j <= count; ++j) {
            auto q = FACE(A[j], A[7*span+j], A[2*span+j], A[9*span+j], A[span+j], A[8*span+j], A[10*span+j],
                A[11*span+j], A[12*span+j], A[13*span+j],
                B[j], B[7*span+j], B[2*span+j], B[9*span+j], B[span+j], B[8*span+j], B[10*span+j],
                B[11*span+j], B[12*span+j], B[13*span+j], zc[j] - zs[j], r, contact);
            N[j] = q[0]; N[span+j] = q[1]; N[2*span+j] = q[2]; N[3*span+j] = q[3];
        }
        if (i - 1 == s.nrows + 1)
            for (int j = 1; j <= count; ++j) edge[3*edge_pitch + col0 - 3 + j] += (double)N[j];
        if (i == 2)
            for (int j = 1; j <= count; ++j) edge[2*edge_pitch + col0 - 3 + j] -= (double)N[j];
        if (i == row0) continue;

        float* __restrict__ E = scratch + (size_t)36 * span;
        #pragma clang loop vectorize(assume_safety) vectorize_width(16)
        for (int j = 0; j <= count; ++j) {
            auto q = FACE(A[j], A[3*span+j], A[span+j], A[4*span+j], A[2*span+j], A[5*span+j], A[6*span+j],
                A[11*span+j], A[12*span+j], A[13*span+j],
                A[j+1], A[3*span+j+1], A[span+j+1], A[4*span+j+1], A[2*span+j+1], A[5*span+j+1],
                A[6*span+j+1], A[11*span+j+1], A[12*span+j+1], A[13*span+j+1], zs[j+1] - zs[j], r, contact);
            E[j] = q[0]; E[span+j] = q[1]; E[2*span+j] = q[2]; E[3*span+j] = q[3];
        }
        if (col0 == 2) edge[i - 3] -= (double)E[0];
        if (col0 + count == s.ncols + 2) edge[edge_pitch + i - 3] += (double)E[count];

        const float* __restrict__ S = scratch + (size_t)(28 + ((i - 1) & 1) * 4) * span;
        const size_t to = (size_t)(i - 1) * pitch + (col0 - 1);
        const float* __restrict__ kd = drag + to;
        float* __restrict__ ho = (float*)f.h_out.data + to;
        float* __restrict__ uo = (float*)f.u_out.data + to;
        float* __restrict__ vo = (float*)f.v_out.data + to;
        #pragma clang loop vectorize(assume_safety) vectorize_width(16)
        for (int j = 1; j <= count; ++j) {
            auto q = UPDATE(hs[j], us[j], vs[j], A[j], A[3*span+j] + A[6*span+j], A[7*span+j] + A[10*span+j],
                E[j], E[span+j], E[3*span+j], E[j-1], E[2*span+j-1], E[3*span+j-1],
                N[j], N[span+j], N[3*span+j], S[j], S[2*span+j], S[3*span+j], kd[j], dt, dx, depth_dry,
                depth_cfl, film_speed);
            ho[j] = q[0]; uo[j] = q[1]; vo[j] = q[2]; speeds[j] = q[3];
        }
        float* __restrict__ m0 = (float*)f.h_max.data + to;
        float* __restrict__ m1 = (float*)f.h_max_time.data + to;
        float* __restrict__ m2 = (float*)f.speed_max.data + to;
        float* __restrict__ m3 = (float*)f.discharge_max.data + to;
        float* __restrict__ m4 = (float*)f.hazard_max.data + to;
        float* __restrict__ m5 = (float*)f.arrival.data + to;
        float* __restrict__ m6 = (float*)f.wet_since.data + to;
        float* __restrict__ m7 = (float*)f.rise_rate_max.data + to;
        #pragma clang loop vectorize(assume_safety) vectorize_width(16)
        for (int j = 1; j <= count; ++j) {
            auto q = WIDEN(ho[j], uo[j], vo[j], speeds[j], hs[j], dt, time, depth_arrival,
                m0[j], m1[j], m2[j], m3[j], m4[j], m5[j], m6[j], m7[j]);
            m0[j] = q[0]; m1[j] = q[1]; m2[j] = q[2]; m3[j] = q[3]; m4[j] = q[4]; m5[j] = q[5];
            m6[j] = q[7]; m7[j] = q[8];
            waves[j-1] = waves[j-1] < q[6] ? q[6] : waves[j-1];
        }
        for (int k = 0; k < f.class_depths.shape[0]; ++k) {
            const float depth = ((const float*)f.class_depths.data)[k];
            float* __restrict__ m = (float*)f.class_arrival.data + (size_t)k * (s.nrows + 4) * pitch + to;
            #pragma clang loop vectorize(assume_safety) vectorize_width(16)
            for (int j = 1; j <= count; ++j) m[j] = ARRIVAL(ho[j], depth, time, m[j]);
        }
    }
    float wave = 0.0f;
    for (int j = 0; j < count; ++j) wave = wave < waves[j] ? waves[j] : wave;
    ((float*)chunk_waves.data)[chunk] = wave;
"""


def _with_names(snippet: str) -> str:
    names = {"PREDICT": predict, "FACE": face_flux, "UPDATE": update_cell, "WIDEN": widen_maxima}
    names |= {"ARRIVAL": arrival_time, "FILM_SPEED": film_speed}
    for word, function in names.items():
        snippet = snippet.replace(word + "(", function.native_func + "(")
    snippet = snippet.replace("NARROW", str(NARROW_COLS))
    return snippet.replace("chunks[", "((const int*)chunk_array.data)[")


@wp.func_native(_with_names(_SWEEP))
def sweep(
    f: Fields,
    s: Scheme,
    chunk_array: wp.array(dtype=wp.int32),
    chunk: int,
    scratch_array: wp.array(dtype=wp.float32),
    scratch_offset: int,
    scratch_pitch: int,
    dt: float,
    stable: float,
    time: float,
    chunk_waves: wp.array(dtype=wp.float32),
):
    """Step one chunk; see the module."""
    ...


_TAKE = r"""
    const int threads = shares.shape[0] - 1;
    const int* bounds = (const int*)shares.data;
    int* next = (int*)taken.data;
    for (int k = 0; k < threads; ++k) {
        const int owner = (thread + k) % threads;
        if (__atomic_load_n(next + owner, __ATOMIC_RELAXED) >= bounds[owner + 1]) continue;
        const int chunk = __atomic_fetch_add(next + owner, 1, __ATOMIC_RELAXED);
        if (chunk < bounds[owner + 1]) return chunk;
    }
    return -1;
"""


@wp.func_native(_TAKE)
def take_chunk(shares: wp.array(dtype=wp.int32), taken: wp.array(dtype=wp.int32), thread: int) -> int:
    """Next chunk of the thread's own share, then of the others'; -1 when all are taken."""
    ...


@wp.kernel(module=ROWS_MODULE)
def step_chunks(
    f: Fields,
    s: Scheme,
    chunk_array: wp.array(dtype=wp.int32),
    thread: int,
    scratch_array: wp.array(dtype=wp.float32),
    scratch_offset: int,
    scratch_pitch: int,
    dt: float,
    stable: float,
    time: float,
    shares: wp.array(dtype=wp.int32),
    # outputs
    taken: wp.array(dtype=wp.int32),
    chunk_waves: wp.array(dtype=wp.float32),
):
    """Step chunks until all are taken: those of the thread's own share, then what slower threads have left.

    Args:
        f: rasters.
        s: scheme.
        chunk_array: first row, one past the last, first column, one past the last of each chunk.
        thread: number of the thread.
        scratch_array: scratch memory of all threads.
        scratch_offset: where this thread's begins.
        scratch_pitch: length of a scratch row.
        dt: time step [s].
        stable: time step that stability alone allows [s].
        time: time after the step [s].
        shares: [threads + 1], first chunk of each thread's share.
        taken: [threads], next chunk of each share.
        chunk_waves: largest wave speed of each chunk [m/s].
    """
    if thread < 0:  # never: tells Warp to generate the functions that the native code calls
        a = predict(
            dt,
            dt,
            dt,
            dt,
            dt,
            dt,
            dt,
            dt,
            dt,
            dt,
            dt,
            dt,
            dt,
            dt,
            dt,
            dt,
            dt,
            dt,
            dt,
            dt,
            dt,
            dt,
            dt,
            dt,
            dt,
            dt,
            dt,
            dt,
        )
        b = face_flux(
            dt, dt, dt, dt, dt, dt, dt, dt, dt, dt, dt, dt, dt, dt, dt, dt, dt, dt, dt, dt, dt, dt, dt
        )
        c = update_cell(
            dt, dt, dt, dt, dt, dt, dt, dt, dt, dt, dt, dt, dt, dt, dt, dt, dt, dt, dt, dt, dt, dt, dt, dt
        )
        d = widen_maxima(dt, dt, dt, dt, dt, dt, dt, dt, dt, dt, dt, dt, dt, dt, dt, dt)
        chunk_waves[0] = a[0] + b[0] + c[0] + d[0] + arrival_time(dt, dt, dt, dt) + film_speed(dt, dt, dt)
    chunk = take_chunk(shares, taken, thread)
    while chunk >= 0:
        sweep(
            f,
            s,
            chunk_array,
            chunk,
            scratch_array,
            scratch_offset,
            scratch_pitch,
            dt,
            stable,
            time,
            chunk_waves,
        )
        chunk = take_chunk(shares, taken, thread)
