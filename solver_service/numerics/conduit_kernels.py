"""Culverts and pumps: water taken from some cells and given to others after the flux step.

The level at an end is that of its deepest cell. A culvert with barrels of width b and height D runs from the
higher level to the lower, H = eta_up - max(inverts), y = min(H, D), by whichever controls it [FHWA2012]:

    inlet, free surface:   Q = (2/3)^1.5 g^0.5 b H^1.5                              (critical flow)
    inlet, drowned:        Q = C_d b D (2 g max(H - D/2, H/2))^0.5                  (orifice)
    outlet, full barrel:   Q = b y [2 g (eta_up - max(eta_down, invert_down + y/2)) / K]^0.5
                           K = K_entrance + 1 + 2 g n^2 L / R^(4/3)

and the least of the three counts. A pump delivers its rating while it runs; it starts at one level and stops
at a lower one.

In a step a structure takes at most half of the water that stands above its intake, a culvert also at most
half of the volume that makes both levels equal, so that it never swings. Water leaves in quanta of 2^-16 m,
which a float32 depth below 256 m gives without rounding, and takes its momentum along; what the outlet gets
brings none. What rounding leaves over stays in the structure and goes out with the next step: volume is
exact.
"""

import warp as wp

from solver_service.numerics.clock_kernels import CLOCK_BEFORE, CLOCK_TIME
from solver_service.numerics.warp_modules import STRUCTURE_MODULE

KIND = wp.constant(0)
INVERT_IN = wp.constant(1)
INVERT_OUT = wp.constant(2)
WIDTH = wp.constant(3)
HEIGHT = wp.constant(4)
BARRELS = wp.constant(5)
LOSS = wp.constant(6)
ORIFICE = wp.constant(7)
BOTH_WAYS = wp.constant(8)
AGAINST_HEAD = wp.constant(9)
START_LEVEL = wp.constant(10)
STOP_LEVEL = wp.constant(11)
NUMBER_COUNT = 12

CULVERT = wp.constant(wp.float64(0.0))
PUMP = wp.constant(wp.float64(1.0))

DUE = wp.constant(0)
"""Volume that waits until it makes a quantum [m3]."""
CARRIED = wp.constant(1)
"""Volume taken and not given yet [m3]."""
MOVED = wp.constant(2)
"""Volume taken at the inlet less that taken at the outlet, since the start [m3]."""
RUNNING = wp.constant(3)
"""1 while a pump runs."""
DISCHARGE = wp.constant(4)
"""Discharge of the last step, from inlet to outlet [m3/s]."""
STATE_COUNT = 5

G = wp.constant(wp.float64(9.81))
CRITICAL = wp.constant(wp.float64(1.7048887766))
"""(2/3)^1.5 g^0.5 [m^0.5/s]."""
ZERO = wp.constant(wp.float64(0.0))
HALF = wp.constant(wp.float64(0.5))
TWO = wp.constant(wp.float64(2.0))
QUANTA_PER_METRE = wp.constant(wp.float64(65536.0))
QUANTUM = wp.constant(wp.float64(0.0000152587890625))


@wp.func
def end_level(
    cells: wp.array2d(dtype=wp.int32),
    first: int,
    last: int,
    h: wp.array2d(dtype=wp.float32),
    z: wp.array2d(dtype=wp.float32),
) -> wp.float64:
    """Water level in the deepest of some cells [m]."""
    level = wp.float64(z[cells[first, 0], cells[first, 1]])
    deepest = float(-1.0)
    for k in range(first, last):
        i = cells[k, 0]
        j = cells[k, 1]
        if h[i, j] > deepest:
            deepest = h[i, j]
            level = wp.float64(z[i, j]) + wp.float64(h[i, j])
    return level


@wp.func
def culvert_discharge(
    numbers: wp.array2d(dtype=wp.float64),
    k: int,
    eta_up: wp.float64,
    eta_down: wp.float64,
    invert_up: wp.float64,
    invert_down: wp.float64,
) -> wp.float64:
    """Discharge of culvert `k` [m3/s] from the higher level to the lower."""
    head = eta_up - wp.max(invert_up, invert_down)
    if head <= ZERO:
        return ZERO
    width = numbers[k, WIDTH]
    height = numbers[k, HEIGHT]
    free = CRITICAL * width * head * wp.sqrt(head)
    centre = wp.max(head - HALF * height, HALF * head)
    drowned = numbers[k, ORIFICE] * width * height * wp.sqrt(TWO * G * centre)
    y = wp.min(head, height)
    fall = wp.max(eta_up - wp.max(eta_down, invert_down + HALF * y), ZERO)
    full = width * y * wp.sqrt(TWO * G * fall / numbers[k, LOSS])
    return numbers[k, BARRELS] * wp.min(wp.min(free, drowned), full)


@wp.func
def rated_discharge(
    ratings: wp.array(dtype=wp.float64),
    rates: wp.array(dtype=wp.float64),
    first: int,
    last: int,
    x: wp.float64,
) -> wp.float64:
    """Discharge of a rating at level or head `x`, linear between its entries, held outside."""
    if x <= ratings[first]:
        return rates[first]
    n = int(first)
    while n < last - 1 and ratings[n + 1] <= x:
        n += 1
    if n == last - 1:
        return rates[n]
    part = (x - ratings[n]) / (ratings[n + 1] - ratings[n])
    return rates[n] + part * (rates[n + 1] - rates[n])


@wp.func
def available_depth(h: float, z: float, intake: wp.float64) -> wp.float64:
    """Half of the water above the intake in a cell [m]."""
    depth = wp.float64(h)
    return HALF * wp.clamp(wp.float64(z) + depth - intake, ZERO, depth)


@wp.func
def take_water(
    cells: wp.array2d(dtype=wp.int32),
    first: int,
    last: int,
    intake: wp.float64,
    volume: wp.float64,
    cell_area: wp.float64,
    depth_dry: float,
    z: wp.array2d(dtype=wp.float32),
    h: wp.array2d(dtype=wp.float32),
    u: wp.array2d(dtype=wp.float32),
    v: wp.array2d(dtype=wp.float32),
) -> wp.float64:
    """Take up to `volume` [m3] in whole quanta, in proportion to what is there; returns what was taken."""
    total = wp.float64(0.0)
    for k in range(first, last):
        total += available_depth(h[cells[k, 0], cells[k, 1]], z[cells[k, 0], cells[k, 1]], intake)
    quanta = wp.floor(volume / cell_area * QUANTA_PER_METRE)
    taken = wp.float64(0.0)
    if total > ZERO and quanta > ZERO:
        for k in range(first, last):
            i = cells[k, 0]
            j = cells[k, 1]
            depth = wp.float64(h[i, j])
            share = wp.floor(quanta * (available_depth(h[i, j], z[i, j], intake) / total))
            share = wp.min(share, wp.floor(depth * QUANTA_PER_METRE))
            left = wp.float32(depth - share * QUANTUM)
            h[i, j] = left
            if left <= depth_dry:
                u[i, j] = 0.0
                v[i, j] = 0.0
            taken += depth - wp.float64(left)
    return taken * cell_area


@wp.func
def give_water(
    cells: wp.array2d(dtype=wp.int32),
    first: int,
    last: int,
    volume: wp.float64,
    cell_area: wp.float64,
    h: wp.array2d(dtype=wp.float32),
    u: wp.array2d(dtype=wp.float32),
    v: wp.array2d(dtype=wp.float32),
) -> wp.float64:
    """Spread up to `volume` [m3] evenly over cells, in whole quanta; returns what was given."""
    count = wp.float64(last - first)
    quanta = wp.floor(volume / (count * cell_area) * QUANTA_PER_METRE)
    given = wp.float64(0.0)
    if quanta > ZERO:
        for k in range(first, last):
            i = cells[k, 0]
            j = cells[k, 1]
            before = h[i, j]
            after = wp.float32(wp.float64(before) + quanta * QUANTUM)
            h[i, j] = after
            u[i, j] = u[i, j] * (before / after)
            v[i, j] = v[i, j] * (before / after)
            given += wp.float64(after) - wp.float64(before)
    return given * cell_area


@wp.kernel(module=STRUCTURE_MODULE)
def run_conduits(
    clock: wp.array(dtype=wp.float64),
    groups: wp.array(dtype=wp.int32),
    numbers: wp.array2d(dtype=wp.float64),
    ends: wp.array2d(dtype=wp.int32),
    cells: wp.array2d(dtype=wp.int32),
    rating_first: wp.array(dtype=wp.int32),
    ratings: wp.array(dtype=wp.float64),
    rates: wp.array(dtype=wp.float64),
    cell_area: wp.float64,
    depth_dry: float,
    z: wp.array2d(dtype=wp.float32),
    # outputs
    h: wp.array2d(dtype=wp.float32),
    u: wp.array2d(dtype=wp.float32),
    v: wp.array2d(dtype=wp.float32),
    states: wp.array2d(dtype=wp.float64),
):
    """Run the culverts and pumps of one group; groups share no cell, within one they run in order.

    Args:
        clock: see `clock_kernels`.
        groups: [groups + 1], first structure of each.
        numbers: [structures, NUMBER_COUNT], see the constants.
        ends: [structures, 3], first inlet cell, first outlet cell, one past the last cell.
        cells: [cells, 2], padded row and column.
        rating_first: [structures + 1], first entry of each rating.
        ratings: joined levels or heads [m].
        rates: joined discharges [m3/s].
        cell_area: [m2].
        depth_dry: water no deeper has no velocity [m].
        z: bed [m], padded.
        h: depth after the step [m], padded.
        u: velocity [m/s], padded.
        v: velocity [m/s], padded.
        states: [structures, STATE_COUNT], see the constants.
    """
    group = wp.tid()
    dt = clock[CLOCK_TIME] - clock[CLOCK_BEFORE]
    if dt <= ZERO:
        return
    for k in range(groups[group], groups[group + 1]):
        in0 = ends[k, 0]
        out0 = ends[k, 1]
        end = ends[k, 2]
        eta_in = end_level(cells, in0, out0, h, z)
        eta_out = eta_in
        if end > out0:
            eta_out = end_level(cells, out0, end, h, z)
        discharge = wp.float64(0.0)
        most = wp.float64(1.0e30)
        intake = wp.float64(-1.0e30)
        way = wp.float64(1.0)
        if numbers[k, KIND] == CULVERT:
            if eta_out > eta_in:
                way = wp.float64(-1.0)
            up = wp.max(eta_in, eta_out)
            down = wp.min(eta_in, eta_out)
            intake = wp.max(numbers[k, INVERT_IN], numbers[k, INVERT_OUT])
            if way > ZERO:
                discharge = culvert_discharge(
                    numbers, k, up, down, numbers[k, INVERT_IN], numbers[k, INVERT_OUT]
                )
            elif numbers[k, BOTH_WAYS] == wp.float64(1.0):
                discharge = culvert_discharge(
                    numbers, k, up, down, numbers[k, INVERT_OUT], numbers[k, INVERT_IN]
                )
            area_in = wp.float64(out0 - in0) * cell_area
            area_out = wp.float64(end - out0) * cell_area
            level = wp.max(up - wp.max(down, intake), ZERO)
            if level < QUANTUM:  # quanta cannot even it out: rounding would set a lake at rest in motion
                level = ZERO
            most = HALF * level * (area_in * area_out / (area_in + area_out))
        else:
            if eta_in >= numbers[k, START_LEVEL]:
                states[k, RUNNING] = wp.float64(1.0)
            elif eta_in <= numbers[k, STOP_LEVEL]:
                states[k, RUNNING] = ZERO
            if states[k, RUNNING] == wp.float64(1.0):
                x = eta_in
                if numbers[k, AGAINST_HEAD] == wp.float64(1.0):
                    x = eta_out - eta_in
                discharge = rated_discharge(ratings, rates, rating_first[k], rating_first[k + 1], x)

        from0 = in0
        from1 = out0
        to0 = out0
        to1 = end
        if way < ZERO:
            from0 = out0
            from1 = end
            to0 = in0
            to1 = out0
        there = wp.float64(0.0)
        for n in range(from0, from1):
            there += available_depth(h[cells[n, 0], cells[n, 1]], z[cells[n, 0], cells[n, 1]], intake)
        volume = wp.min(discharge * dt, wp.min(most, there * cell_area))
        states[k, DISCHARGE] = way * volume / dt
        due = states[k, DUE] + volume
        taken = take_water(cells, from0, from1, intake, due, cell_area, depth_dry, z, h, u, v)
        states[k, DUE] = wp.min(due - taken, wp.float64(from1 - from0) * cell_area * QUANTUM)
        states[k, MOVED] = states[k, MOVED] + way * taken
        carried = states[k, CARRIED] + taken
        if to1 > to0:
            carried -= give_water(cells, to0, to1, carried, cell_area, h, u, v)
        else:
            carried = ZERO
        states[k, CARRIED] = carried
