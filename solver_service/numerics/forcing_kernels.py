"""Water that comes from outside: point and disc discharges, and rain.

A series is linear or stepped between its times, zero before the first and held after the last; V(t) is
its exact integral from time 0 on. What is due as depth, V / area, is handed out in quanta of 2^-16 m (15
micrometres): any float32 depth below 256 m is raised by a quantum without rounding, so that rain on a deep
lake is not lost and the budget closes. New water brings no momentum.
"""

import warp as wp

from solver_service.numerics.clock_kernels import CLOCK_TIME
from solver_service.numerics.warp_modules import SUPPORT_MODULE

QUANTUM = 2.0**-16
"""Smallest depth handed out [m]."""


@wp.kernel(module=SUPPORT_MODULE)
def release_water(
    clock: wp.array(dtype=wp.float64),
    first: wp.array(dtype=wp.int32),
    times: wp.array(dtype=wp.float64),
    rates: wp.array(dtype=wp.float64),
    volumes: wp.array(dtype=wp.float64),
    areas: wp.array(dtype=wp.float64),
    stepped: wp.array(dtype=wp.int32),
    # outputs
    released: wp.array(dtype=wp.float64),
    depths: wp.array(dtype=wp.float32),
):
    """Depth [m] that each series hands out up to the present time, and the quanta released in all.

    Args:
        clock: see `clock_kernels`.
        first: [series + 1], where each series begins in the joined arrays.
        times: joined times [s].
        rates: joined discharges [m3/s] or rain rates [m/s].
        volumes: V at the times.
        areas: [series], area the water is spread over [m2], 1 for rain.
        stepped: [series], 1 where the rate holds until the next time, 0 where it is linear.
        released: [series], quanta handed out so far.
        depths: [series], depth to add now [m].
    """
    k = wp.tid()
    time = clock[CLOCK_TIME]
    begin = first[k]
    end = first[k + 1] - 1
    volume = wp.float64(0.0)
    if time >= times[end]:
        volume = volumes[end] + rates[end] * (time - times[end])
    elif time > times[begin]:
        n = int(begin)
        while times[n + 1] <= time:
            n += 1
        part = time - times[n]
        slope = (rates[n + 1] - rates[n]) / (times[n + 1] - times[n])
        if stepped[k] == 1:
            slope = wp.float64(0.0)
        volume = volumes[n] + part * (rates[n] + wp.float64(0.5) * slope * part)
    # what is due never falls, but its last bit may where one series follows another
    quanta = wp.max(wp.floor(volume / areas[k] * wp.float64(65536.0)), released[k])
    depths[k] = wp.float32((quanta - released[k]) * wp.float64(0.0000152587890625))
    released[k] = quanta


@wp.kernel(module=SUPPORT_MODULE)
def add_source_water(
    series: int,
    depths: wp.array(dtype=wp.float32),
    rows: wp.array(dtype=wp.int32),
    cols: wp.array(dtype=wp.int32),
    # outputs
    h: wp.array2d(dtype=wp.float32),
    u: wp.array2d(dtype=wp.float32),
    v: wp.array2d(dtype=wp.float32),
):
    """Raise the cells of one source."""
    k = wp.tid()
    depth = depths[series]
    if depth > 0.0:
        i = rows[k] + 2
        j = cols[k] + 2
        before = h[i, j]
        after = before + depth
        h[i, j] = after
        u[i, j] = u[i, j] * (before / after)
        v[i, j] = v[i, j] * (before / after)


@wp.kernel(module=SUPPORT_MODULE)
def add_rain(
    first_series: int,
    rain_cols: int,
    depths: wp.array(dtype=wp.float32),
    row_index: wp.array(dtype=wp.int32),
    col_index: wp.array(dtype=wp.int32),
    roof: wp.array2d(dtype=wp.int8),
    # outputs
    h: wp.array2d(dtype=wp.float32),
    u: wp.array2d(dtype=wp.float32),
    v: wp.array2d(dtype=wp.float32),
):
    """Raise every cell that is not blocked by what its rain cell hands out."""
    row, col = wp.tid()
    depth = depths[first_series + row_index[row] * rain_cols + col_index[col]]
    if depth > 0.0 and roof[row, col] == wp.int8(0):
        i = row + 2
        j = col + 2
        before = h[i, j]
        after = before + depth
        h[i, j] = after
        u[i, j] = u[i, j] * (before / after)
        v[i, j] = v[i, j] * (before / after)
