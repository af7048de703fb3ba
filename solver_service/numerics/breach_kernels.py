"""Breaches grow and lower the bed; see `breach` for the laws.

Where the opening has width B at its bottom level L and sides of slope m (horizontal per vertical), the ground
z_b at way x from its middle is cut by

    D = max(z_b - L, 0),   cut(x) = D for x <= B/2,  max(D - (x - B/2) / m, 0) beyond

A cell gets the mean of the cut over its side, so that it sinks steadily while an edge of the opening passes
it. The integral from 0 to x is D min(x, B/2) + D y - y^2 / (2 m), y = min(max(x - B/2, 0), m D).

The width by Verheij and van der Knaap is integrated over a step with the head dH held:

    B += f1 g^0.5 dH^1.5 / u_c  log10[(1 + f2 g t_1 / u_c) / (1 + f2 g t_0 / u_c)]        (t in hours)

which is the law itself while dH does not change. The bed sinks under the water: h, u and v stay.
"""

import warp as wp

from solver_service.numerics.clock_kernels import CLOCK_BEFORE, CLOCK_TIME
from solver_service.numerics.warp_modules import STRUCTURE_MODULE

START_TIME = wp.constant(0)
STARTS_WHEN_OVERTOPPED = wp.constant(1)
CREST = wp.constant(2)
BOTTOM = wp.constant(3)
DURATION = wp.constant(4)
WIDTH_INITIAL = wp.constant(5)
WIDTH_FINAL = wp.constant(6)
IS_LINEAR = wp.constant(7)
GROWTH = wp.constant(8)
"""f1 g^0.5 / u_c [m^(-0.5)]."""
DECAY = wp.constant(9)
"""f2 g / u_c [1/h]."""
SIDE_SLOPE = wp.constant(10)
NUMBER_COUNT = 11

STARTED = wp.constant(0)
WIDTH = wp.constant(1)
LEVEL = wp.constant(2)
STATE_COUNT = 3

NOT_STARTED = wp.constant(wp.float64(-1.0))
SECONDS_PER_HOUR = wp.constant(wp.float64(3600.0))


@wp.func
def water_level(
    h: wp.array2d(dtype=wp.float32), z: wp.array2d(dtype=wp.float32), i: int, j: int
) -> wp.float64:
    """Level of the water in padded cell (i, j) [m], the bed where dry."""
    return wp.float64(z[i, j]) + wp.float64(h[i, j])


@wp.kernel(module=STRUCTURE_MODULE)
def grow_breaches(
    clock: wp.array(dtype=wp.float64),
    h: wp.array2d(dtype=wp.float32),
    z: wp.array2d(dtype=wp.float32),
    numbers: wp.array2d(dtype=wp.float64),
    probes: wp.array2d(dtype=wp.int32),
    depth_dry: float,
    # outputs
    states: wp.array2d(dtype=wp.float64),
):
    """Begin breaches that are due, and let those that have begun grow.

    Args:
        clock: see `clock_kernels`.
        h: depth after the step [m], padded.
        z: bed [m], padded.
        numbers: [breaches, NUMBER_COUNT], see the constants.
        probes: [breaches, 4], padded row and column of both probes.
        depth_dry: depth from which water counts [m].
        states: [breaches, STATE_COUNT], time of the beginning [s] or NOT_STARTED, width [m] and level [m].
    """
    b = wp.tid()
    before = clock[CLOCK_BEFORE]
    after = clock[CLOCK_TIME]
    if after <= before:
        return
    i0 = probes[b, 0]
    j0 = probes[b, 1]
    i1 = probes[b, 2]
    j1 = probes[b, 3]
    highest = wp.float64(-1.0e30)
    if h[i0, j0] > depth_dry:
        highest = water_level(h, z, i0, j0)
    if h[i1, j1] > depth_dry:
        highest = wp.max(highest, water_level(h, z, i1, j1))
    lowest = wp.min(water_level(h, z, i0, j0), water_level(h, z, i1, j1))

    started = states[b, STARTED]
    if started == NOT_STARTED and after >= numbers[b, START_TIME]:
        if numbers[b, STARTS_WHEN_OVERTOPPED] == wp.float64(0.0):
            started = numbers[b, START_TIME]
        elif highest > numbers[b, CREST]:
            started = after
        states[b, STARTED] = started
    if started == NOT_STARTED:
        return
    crest = numbers[b, CREST]
    bottom = numbers[b, BOTTOM]
    first = numbers[b, WIDTH_INITIAL]
    final = numbers[b, WIDTH_FINAL]
    part = wp.clamp((after - started) / numbers[b, DURATION], wp.float64(0.0), wp.float64(1.0))
    level = crest + part * (bottom - crest)
    if part >= wp.float64(1.0):
        level = bottom
    states[b, LEVEL] = level
    if numbers[b, IS_LINEAR] == wp.float64(1.0):
        states[b, WIDTH] = first + part * (final - first)
        return
    widening = started + numbers[b, DURATION]
    width = wp.max(states[b, WIDTH], first)
    head = highest - wp.max(lowest, bottom)
    if after > widening and head > wp.float64(0.0):
        t0 = wp.max(before - widening, wp.float64(0.0)) / SECONDS_PER_HOUR
        t1 = (after - widening) / SECONDS_PER_HOUR
        decay = numbers[b, DECAY]
        grown = wp.log10((wp.float64(1.0) + decay * t1) / (wp.float64(1.0) + decay * t0))
        width += numbers[b, GROWTH] * head * wp.sqrt(head) * grown
    states[b, WIDTH] = wp.min(width, final)


@wp.func
def cut_up_to(x: wp.float64, depth: wp.float64, half: wp.float64, side_slope: wp.float64) -> wp.float64:
    """Integral of the cut from the middle to `x` [m2]; odd in `x`."""
    way = wp.abs(x)
    area = depth * wp.min(way, half)
    if side_slope > wp.float64(0.0):
        y = wp.clamp(way - half, wp.float64(0.0), side_slope * depth)
        area += depth * y - y * y / (wp.float64(2.0) * side_slope)
    return wp.where(x < wp.float64(0.0), -area, area)


@wp.kernel(module=STRUCTURE_MODULE)
def lower_bed(
    numbers: wp.array2d(dtype=wp.float64),
    states: wp.array2d(dtype=wp.float64),
    owners: wp.array(dtype=wp.int32),
    cells: wp.array2d(dtype=wp.int32),
    along: wp.array(dtype=wp.float64),
    ground: wp.array(dtype=wp.float32),
    dx: wp.float64,
    # outputs
    z: wp.array2d(dtype=wp.float32),
):
    """Set the bed of the cells that the breaches eat.

    Args:
        numbers: see `grow_breaches`.
        states: see `grow_breaches`.
        owners: breach of each cell.
        cells: [cells, 2], padded row and column.
        along: way from the middle of the breach along its line [m].
        ground: bed without the breach [m].
        dx: cell side [m].
        z: bed [m], padded.
    """
    k = wp.tid()
    b = owners[k]
    bed = wp.float64(ground[k])
    depth = bed - states[b, LEVEL]
    if states[b, STARTED] != NOT_STARTED and depth > wp.float64(0.0):
        half = wp.float64(0.5) * states[b, WIDTH]
        side_slope = numbers[b, SIDE_SLOPE]
        east = cut_up_to(along[k] + wp.float64(0.5) * dx, depth, half, side_slope)
        west = cut_up_to(along[k] - wp.float64(0.5) * dx, depth, half, side_slope)
        z[cells[k, 0], cells[k, 1]] = wp.float32(bed - (east - west) / dx)
    else:
        z[cells[k, 0], cells[k, 1]] = ground[k]


@wp.kernel(module=STRUCTURE_MODULE)
def read_bed(
    z: wp.array2d(dtype=wp.float32),
    cells: wp.array2d(dtype=wp.int32),
    # outputs
    bed: wp.array(dtype=wp.float32),
):
    """Bed of the listed cells [m]; `z` is padded, `cells` are padded rows and columns, [cells, 2]."""
    k = wp.tid()
    bed[k] = z[cells[k, 0], cells[k, 1]]
