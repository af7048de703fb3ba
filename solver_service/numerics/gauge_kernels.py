"""Gauges: the state of single cells at fixed times, interpolated between the steps around them."""

import warp as wp

from solver_service.numerics.clock_kernels import CLOCK_BEFORE, CLOCK_TIME
from solver_service.numerics.fields import Fields
from solver_service.numerics.warp_modules import SUPPORT_MODULE


@wp.kernel(module=SUPPORT_MODULE)
def record_gauges(
    f: Fields,
    clock: wp.array(dtype=wp.float64),
    rows: wp.array(dtype=wp.int32),
    cols: wp.array(dtype=wp.int32),
    interval: wp.float64,
    cursor: wp.array(dtype=wp.int32),
    # outputs
    records: wp.array2d(dtype=wp.vec4),
):
    """Write h, eta, u, v of each gauge for every gauge time that the step from `f` passed.

    Args:
        f: rasters; the step has just gone from `h` to `h_out`.
        clock: see `clock_kernels`.
        rows: gauge rows.
        cols: gauge columns.
        interval: time between records [s].
        cursor: [2], number of the next record, and of the record that stands first in `records`.
        records: [capacity, gauges].
    """
    k = wp.tid()
    i = rows[k] + 2
    j = cols[k] + 2
    before = clock[CLOCK_BEFORE]
    after = clock[CLOCK_TIME]
    n = int(cursor[0])
    while wp.float64(n) * interval <= after and after > before:
        w = wp.float32((wp.float64(n) * interval - before) / (after - before))
        h = f.h[i, j] + w * (f.h_out[i, j] - f.h[i, j])
        u = f.u[i, j] + w * (f.u_out[i, j] - f.u[i, j])
        v = f.v[i, j] + w * (f.v_out[i, j] - f.v[i, j])
        records[n - cursor[1], k] = wp.vec4(h, f.z[i, j] + h, u, v)
        n += 1


@wp.kernel(module=SUPPORT_MODULE)
def advance_gauge_cursor(
    clock: wp.array(dtype=wp.float64),
    interval: wp.float64,
    # outputs
    cursor: wp.array(dtype=wp.int32),
):
    """Move the cursor past the gauge times that are recorded."""
    n = int(cursor[0])
    while wp.float64(n) * interval <= clock[CLOCK_TIME]:
        n += 1
    cursor[0] = n
