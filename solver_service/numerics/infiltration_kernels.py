"""Infiltration: what the ground takes from the water that stands on it.

With F the depth infiltrated so far, the ground can take

    constant      dF/dt = rate                              until F reaches the capacity
    Horton        dF/dt = fc + (f0 - fc) exp(-k t')         t' from F = fc t' + (f0 - fc) (1 - exp(-k t')) / k
    Green-Ampt    dF/dt = K (1 + (psi + h) deficit / F)

Horton's capacity falls with what has been taken in, not with the clock [Akan1992], so that ground stays
thirsty until water comes. Green-Ampt is integrated over a step by the midpoint rule in F^2, which is exact
where suction rules, F ~ sqrt(t), and where conductivity does, F ~ t [GreenAmpt1911], [Mein1973].

Water leaves in quanta of 2^-20 m (2^-16 m from 8 m of depth on), so that neither depth nor F rounds and the
budget closes; what is due and smaller than a quantum waits. Ground takes water deeper than `depth_film`
alone: thinner water does not move, and its tile may sleep.
"""

import warp as wp

from solver_service.numerics.clock_kernels import CLOCK_DT
from solver_service.numerics.fields import Fields
from solver_service.numerics.warp_modules import SUPPORT_MODULE

TILE_SIDE = wp.constant(16)
TILE_CELLS = wp.constant(256)

CONSTANT = wp.constant(0)
HORTON = wp.constant(1)
GREEN_AMPT = wp.constant(2)

HORTON_ITERATIONS = wp.constant(4)
"""Halley steps for k t', at most."""

HORTON_CLOSE = wp.constant(0.03)
"""A step no longer than this is the last: each leaves the third power of the error, here 1e-5."""


@wp.func
def constant_depth(infiltrated: float, rate: float, capacity: float, dt: float) -> float:
    """Depth that the ground takes in dt [m]."""
    return wp.max(wp.min(rate * dt, capacity - infiltrated), 0.0)


@wp.func
def horton_depth(infiltrated: float, f0: float, fc: float, k: float, dt: float) -> float:
    """Depth that the ground takes in dt [m]."""
    fall = f0 - fc
    if k <= 0.0 or fall <= 0.0:
        return fc * dt + wp.where(k <= 0.0, fall * dt, 0.0)
    # x = k t' solves r x + (1 - r) (1 - exp(-x)) = y. Its first guess comes from exp(-x) ~ (2 - x) / (2 + x);
    # the curve lies under its first tangent and its asymptote, so that both bound x from below.
    y = k * infiltrated / f0
    r = fc / f0
    half = 1.0 - 0.5 * y
    low = y
    if fc > 0.0:
        low = wp.max(low, (y - (1.0 - r)) / r)
    x = wp.max(2.0 * y / wp.max(half + wp.sqrt(half * half + 2.0 * r * y), 1.0e-3), low)
    left = float(1.0)
    change = float(1.0)
    count = int(0)
    while wp.abs(change) > HORTON_CLOSE and count < HORTON_ITERATIONS:
        left = wp.exp(-x)
        slope = wp.max(r + (1.0 - r) * left, 1.0e-20)
        newton = wp.clamp((r * x + (1.0 - r) * (1.0 - left) - y) / slope, -4.0, 4.0)
        after = wp.max(x - newton / wp.max(1.0 + 0.5 * newton * (1.0 - r) * left / slope, 0.5), low)
        change = after - x
        x = after
        count += 1
    left = wp.where(wp.abs(change) > HORTON_CLOSE, wp.exp(-x), left * (1.0 - change * (1.0 - 0.5 * change)))
    part = k * dt
    decay = part * (1.0 - 0.5 * part * (1.0 - part * (1.0 / 3.0)))
    if part > 0.02:
        decay = 1.0 - wp.exp(-part)
    return fc * dt + fall * left * decay / k


@wp.func
def green_ampt_depth(infiltrated: float, conductivity: float, head: float, dt: float) -> float:
    """Depth that the ground takes in dt [m]; `head` is (psi + h) deficit [m]."""
    soaked = conductivity * dt
    pull = soaked * (2.0 * head + infiltrated)
    after = 0.5 * (soaked + wp.sqrt(soaked * soaked + 4.0 * (infiltrated * infiltrated + pull)))
    return soaked * (2.0 * head + infiltrated + after) / wp.max(infiltrated + after, 1.0e-30)


@wp.kernel(module=SUPPORT_MODULE)
def infiltrate(
    f: Fields,
    clock: wp.array(dtype=wp.float64),
    kind: int,
    zones: wp.array2d(dtype=wp.int16),
    parameters: wp.array2d(dtype=wp.float32),
    depth_film: float,
    depth_dry: float,
    nrows: int,
    ncols: int,
    tiles: wp.array(dtype=wp.int32),
    tile_count: wp.array(dtype=wp.int32),
    tile_cols: int,
    stride: int,
    # outputs
    infiltrated: wp.array2d(dtype=wp.float32),
    due: wp.array2d(dtype=wp.float32),
):
    """Take from `h_out` of the cells of the active tiles what the ground takes in the clock's dt.

    Args:
        f: rasters.
        clock: see `clock_kernels`.
        kind: CONSTANT, HORTON or GREEN_AMPT.
        zones: zone of each cell, [nrows, ncols], or [1, 1] where all are alike.
        parameters: three numbers of each zone, [zones, 3], in the order of the functions' arguments.
        depth_film: water no deeper stays [m].
        depth_dry: water no deeper has no velocity [m].
        nrows: grid rows.
        ncols: grid columns.
        tiles: active tiles, row-major numbers.
        tile_count: [1], how many.
        tile_cols: tiles in a row of tiles.
        stride: number of threads.
        infiltrated: depth infiltrated since the start [m], [nrows, ncols].
        due: depth that the ground could have taken and has not, less than a quantum [m], [nrows, ncols].
    """
    thread = wp.tid()
    dt = wp.float32(clock[CLOCK_DT])
    work = tile_count[0] * TILE_CELLS
    if dt <= 0.0:
        work = 0
    number = int(thread)
    while number < work:
        tile = tiles[number // TILE_CELLS]
        cell = number % TILE_CELLS
        row = (tile // tile_cols) * TILE_SIDE + cell // TILE_SIDE
        col = (tile % tile_cols) * TILE_SIDE + cell % TILE_SIDE
        number += stride
        if row < nrows and col < ncols:
            h = f.h_out[row + 2, col + 2]
            if h > depth_film:
                zone = int(0)
                if zones.shape[0] > 1:
                    zone = int(zones[row, col])
                a = parameters[zone, 0]
                b = parameters[zone, 1]
                c = parameters[zone, 2]
                taken_before = infiltrated[row, col]
                waiting = due[row, col]
                before = taken_before + waiting
                if kind == CONSTANT:
                    waiting += constant_depth(before, a, b, dt)
                elif kind == HORTON:
                    waiting += horton_depth(before, a, b, c, dt)
                else:
                    waiting += green_ampt_depth(before, a, (b + h) * c, dt)
                quantum = wp.where(h < 8.0, 9.5367431640625e-07, 1.52587890625e-05)
                taken = wp.floor(wp.min(waiting, h) / quantum) * quantum
                left = h - taken
                infiltrated[row, col] = taken_before + taken
                due[row, col] = wp.min(waiting - taken, quantum)
                f.h_out[row + 2, col + 2] = left
                if left <= depth_dry:
                    f.u_out[row + 2, col + 2] = 0.0
                    f.v_out[row + 2, col + 2] = 0.0
