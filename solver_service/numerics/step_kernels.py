"""The fused step: one kernel takes every cell of the active tiles from one state to the next.

This is the engine of CUDA devices and, launched on the CPU, the oracle and the fallback of the row engine.
A cell computes the predictions of itself and its neighbours and its four faces; a face computed from both
sides gives the same float. Threads walk over the cells of the active tiles with a fixed stride, so that the
launch, hence the captured graph, does not depend on how many tiles are active.
"""

import warp as wp

from solver_service.numerics.clock_kernels import CLOCK_DT, CLOCK_STABLE, CLOCK_TIME
from solver_service.numerics.conservative_update import (
    arrival_time,
    film_speed,
    maxima,
    update_cell,
    widen_maxima,
)
from solver_service.numerics.fields import Fields, Scheme
from solver_service.numerics.reconstruction import predict, prediction
from solver_service.numerics.riemann import face_flux
from solver_service.numerics.warp_modules import STEP_MODULE

TILE_SIDE = wp.constant(16)
TILE_CELLS = wp.constant(256)


@wp.func
def predict_at(f: Fields, s: Scheme, i: int, j: int, half_dt: float) -> prediction:
    """Prediction of padded cell (i, j)."""
    return predict(
        f.h[i, j],
        f.u[i, j],
        f.v[i, j],
        f.z[i, j],
        f.h[i, j - 1],
        f.u[i, j - 1],
        f.v[i, j - 1],
        f.z[i, j - 1],
        f.h[i, j + 1],
        f.u[i, j + 1],
        f.v[i, j + 1],
        f.z[i, j + 1],
        f.h[i - 1, j],
        f.u[i - 1, j],
        f.v[i - 1, j],
        f.z[i - 1, j],
        f.h[i + 1, j],
        f.u[i + 1, j],
        f.v[i + 1, j],
        f.z[i + 1, j],
        f.drag[i, j],
        half_dt,
        s.dx,
        s.theta,
        s.depth_dry,
        s.depth_film,
        s.hancock,
        s.eddy,
    )


@wp.func
def flux_x(l: prediction, r: prediction, z_step: float, dt_dx: float, contact: float) -> wp.vec4:
    """Flux through the face between a western and an eastern cell."""
    return face_flux(
        l[0], l[3], l[1], l[4], l[2], l[5], l[6], l[11], l[12], l[13],
        r[0], r[3], r[1], r[4], r[2], r[5], r[6], r[11], r[12], r[13],
        z_step, dt_dx, contact,
    )  # fmt: skip


@wp.func
def flux_y(l: prediction, r: prediction, z_step: float, dt_dx: float, contact: float) -> wp.vec4:
    """Flux through the face between a southern and a northern cell; v is normal."""
    return face_flux(
        l[0], l[7], l[2], l[9], l[1], l[8], l[10], l[11], l[12], l[13],
        r[0], r[7], r[2], r[9], r[1], r[8], r[10], r[11], r[12], r[13],
        z_step, dt_dx, contact,
    )  # fmt: skip


@wp.func
def keep_maxima(f: Fields, i: int, j: int, m: maxima):
    """Write what `widen_maxima` has found for padded cell (i, j)."""
    f.h_max[i, j] = m[0]
    f.h_max_time[i, j] = m[1]
    f.speed_max[i, j] = m[2]
    f.discharge_max[i, j] = m[3]
    f.hazard_max[i, j] = m[4]
    f.arrival[i, j] = m[5]
    f.wet_since[i, j] = m[7]
    f.rise_rate_max[i, j] = m[8]


@wp.func
def step_cell(f: Fields, s: Scheme, i: int, j: int, dt: float, stable: float, time: float) -> float:
    """Advance padded cell (i, j); returns its wave speed [m/s]."""
    h = f.h[i, j]
    u = f.u[i, j]
    v = f.v[i, j]
    z = f.z[i, j]
    half_dt = 0.5 * dt
    r = dt / s.dx
    c = predict_at(f, s, i, j, half_dt)
    e = flux_x(c, predict_at(f, s, i, j + 1, half_dt), f.z[i, j + 1] - z, r, s.contact)
    w = flux_x(predict_at(f, s, i, j - 1, half_dt), c, z - f.z[i, j - 1], r, s.contact)
    n = flux_y(c, predict_at(f, s, i + 1, j, half_dt), f.z[i + 1, j] - z, r, s.contact)
    b = flux_y(predict_at(f, s, i - 1, j, half_dt), c, z - f.z[i - 1, j], r, s.contact)
    q = update_cell(
        h, u, v, c[0], c[3] + c[6], c[7] + c[10],
        e[0], e[1], e[3], w[0], w[2], w[3],
        n[0], n[1], n[3], b[0], b[2], b[3],
        f.drag[i, j], dt, s.dx, s.depth_dry, s.depth_cfl, film_speed(s.courant, s.depth_cfl, stable),
    )  # fmt: skip
    if j == 2:
        f.edge_flow[0, i - 2] = f.edge_flow[0, i - 2] - wp.float64(w[0])
    if j == s.ncols + 1:
        f.edge_flow[1, i - 2] = f.edge_flow[1, i - 2] + wp.float64(e[0])
    if i == 2:
        f.edge_flow[2, j - 2] = f.edge_flow[2, j - 2] - wp.float64(b[0])
    if i == s.nrows + 1:
        f.edge_flow[3, j - 2] = f.edge_flow[3, j - 2] + wp.float64(n[0])
    m = widen_maxima(
        q[0], q[1], q[2], q[3], h, dt, time, s.depth_arrival,
        f.h_max[i, j], f.h_max_time[i, j], f.speed_max[i, j],
        f.discharge_max[i, j], f.hazard_max[i, j], f.arrival[i, j],
        f.wet_since[i, j], f.rise_rate_max[i, j],
    )  # fmt: skip
    f.h_out[i, j] = q[0]
    f.u_out[i, j] = q[1]
    f.v_out[i, j] = q[2]
    keep_maxima(f, i, j, m)
    return m[6]


@wp.kernel(module=STEP_MODULE)
def step_active_tiles(
    f: Fields,
    s: Scheme,
    clock: wp.array(dtype=wp.float64),
    tiles: wp.array(dtype=wp.int32),
    tile_count: wp.array(dtype=wp.int32),
    tile_cols: int,
    stride: int,
    # outputs
    wave_slots: wp.array(dtype=wp.float32),
):
    """Advance all cells of the active tiles by the clock's dt; with dt = 0 copy them.

    Args:
        f: rasters.
        s: scheme.
        clock: see `clock_kernels`.
        tiles: active tiles, row-major numbers.
        tile_count: [1], how many.
        tile_cols: tiles in a row of tiles.
        stride: number of threads.
        wave_slots: largest wave speed seen [m/s], any slot.
    """
    thread = wp.tid()
    dt = wp.float32(clock[CLOCK_DT])
    stable = wp.float32(clock[CLOCK_STABLE])
    time = wp.float32(clock[CLOCK_TIME])
    work = tile_count[0] * TILE_CELLS
    wave = float(0.0)
    k = int(thread)
    while k < work:
        tile = tiles[k // TILE_CELLS]
        cell = k % TILE_CELLS
        row = (tile // tile_cols) * TILE_SIDE + cell // TILE_SIDE
        col = (tile % tile_cols) * TILE_SIDE + cell % TILE_SIDE
        if row < s.nrows and col < s.ncols:
            if dt > 0.0:
                wave = wp.max(wave, step_cell(f, s, row + 2, col + 2, dt, stable, time))
            else:
                f.h_out[row + 2, col + 2] = f.h[row + 2, col + 2]
                f.u_out[row + 2, col + 2] = f.u[row + 2, col + 2]
                f.v_out[row + 2, col + 2] = f.v[row + 2, col + 2]
        k += stride
    if wave > 0.0:
        wp.atomic_max(wave_slots, thread % wave_slots.shape[0], wave)


@wp.kernel(module=STEP_MODULE)
def keep_class_arrivals(
    f: Fields,
    s: Scheme,
    clock: wp.array(dtype=wp.float64),
    tiles: wp.array(dtype=wp.int32),
    tile_count: wp.array(dtype=wp.int32),
    tile_cols: int,
    stride: int,
):
    """Widen the arrival times by depth class of the cells that the step has just advanced.

    Arguments are those of `step_active_tiles`.
    """
    time = wp.float32(clock[CLOCK_TIME])
    work = tile_count[0] * TILE_CELLS
    if clock[CLOCK_DT] <= wp.float64(0.0):
        work = 0
    k = int(wp.tid())
    while k < work:
        tile = tiles[k // TILE_CELLS]
        cell = k % TILE_CELLS
        row = (tile // tile_cols) * TILE_SIDE + cell // TILE_SIDE
        col = (tile % tile_cols) * TILE_SIDE + cell % TILE_SIDE
        if row < s.nrows and col < s.ncols:
            h = f.h_out[row + 2, col + 2]
            for n in range(f.class_depths.shape[0]):
                arrival = f.class_arrival[n, row + 2, col + 2]
                f.class_arrival[n, row + 2, col + 2] = arrival_time(h, f.class_depths[n], time, arrival)
        k += stride
