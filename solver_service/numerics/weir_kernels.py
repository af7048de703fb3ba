"""Walls thinner than a cell: the cells beside their faces, stepped anew from the old state.

The flux step knows no walls. The cells that have one at a face are computed a second time, by the same
functions but with the flux of the wall at its faces, and their maxima go on from what they were before the
step. Both cells of a face compute the same float, so that volume is kept as everywhere; at every other face
the flux is the one that the neighbour got in the flux step. Floods without walls pay nothing.

A wall with its crest at level w, hs = max(eta - w, 0) on either side, passes water above the crest alone:

    q = C hs_up^1.5 [1 - (hs_down / hs_up)^1.5]^0.385          [Poleni1717], [Villemonte1947]

and never more than the Riemann flux of the layers hs on both sides, which also starts the flow from rest and
keeps it from swinging where the levels are nearly equal. Where a wall is lower than a fifth of the depth its
hindrance fades with the square of its height; a buried one has none. A wall along a staircase of faces is
longer than its line: C is lessened by that ratio.

The layers have the velocity of their columns gathered above the crest, u h / hs, at most the critical one.

Momentum: each side sees a wall that gives way with the velocity w = q / h, and takes the Riemann flux between
its own state (h, u) and the mirrored one (h, 2 w - u). That is a reflecting wall where nothing passes, no
force where all that comes passes, and the common flux of both sides where the wall vanishes. At rest every
term is zero. Thin water beyond the wall gets at most w = (4 g q)^(1/3), the velocity at which q runs out over
dry ground. Velocity and surface are linear up to the wall; in a cell between two walls they are constant
across.
"""

import warp as wp

from solver_service.numerics.clock_kernels import CLOCK_DT, CLOCK_STABLE, CLOCK_TIME
from solver_service.numerics.conservative_update import arrival_time, film_speed, update_cell, widen_maxima
from solver_service.numerics.fields import Fields, Scheme
from solver_service.numerics.friction import GRAVITY
from solver_service.numerics.reconstruction import prediction
from solver_service.numerics.riemann import FACE_TOLERANCE, LAST_PLACE
from solver_service.numerics.step_kernels import flux_x, flux_y, keep_maxima, predict_at
from solver_service.numerics.warp_modules import STRUCTURE_MODULE

ROW = wp.constant(0)
COL = wp.constant(1)
TILE_NUMBER = wp.constant(2)
EAST = wp.constant(3)
WEST = wp.constant(4)
NORTH = wp.constant(5)
SOUTH = wp.constant(6)
CELL_LENGTH = 7
"""Padded row and column, tile, and the wall at each side or -1."""

LEFT_IS_BETWEEN = wp.constant(1)
RIGHT_IS_BETWEEN = wp.constant(2)
"""Bits of a face whose left or right cell lies between two walls."""

KEPT_LENGTH = wp.constant(8)
"""Maxima of a cell besides the arrival times by depth class."""

LOW_SILL = wp.constant(0.2)
"""Height of a wall, in units of the deeper water, below which its hindrance fades [1]."""

side = wp.types.vector(length=8, dtype=wp.float32)
"""Depth, normal and tangential velocity and bed offset at the face, celerity, centre depth, outflow caps
through a face on the right and on the left."""


@wp.func
def side_state(p: prediction, h: float, u: float, v: float, is_x: bool, way: float, is_between: bool) -> side:
    """What a cell shows to a wall on its right (`way` 1) or left (-1)."""
    d = p[0] + way * p[3]
    n = p[1] + way * p[4]
    t = p[2] + way * p[5]
    offset = way * p[6]
    n_cell = u
    t_cell = v
    if not is_x:
        d = p[0] + way * p[7]
        n = p[2] + way * p[9]
        t = p[1] + way * p[8]
        offset = way * p[10]
        n_cell = v
        t_cell = u
    rightward = p[12] * (d * wp.max(n + p[11], 0.0))
    leftward = p[12] * (d * wp.max(p[11] - n, 0.0))
    if is_between:
        return side(h, n_cell, t_cell, 0.0, p[11], p[0], rightward, leftward)
    return side(d, n, t, offset, p[11], p[0], rightward, leftward)


@wp.func
def constant_state(h: float, u: float, c: float) -> prediction:
    """A cell without slopes that moves along x and may give all it has."""
    p = prediction()
    p[0] = h
    p[1] = u
    p[11] = c
    p[12] = 1.0
    return p


@wp.func
def level_flux(
    h_l: float, u_l: float, c_l: float, h_r: float, u_r: float, c_r: float, dt_dx: float
) -> wp.vec4:
    """Flux between two constant states over a level bed."""
    return flux_x(constant_state(h_l, u_l, c_l), constant_state(h_r, u_r, c_r), 0.0, dt_dx, 1.0)


@wp.func
def over_crest(h: float, u: float, layer: float) -> float:
    """Velocity of the layer above the crest: that of the column gathered, at most critical."""
    critical = wp.sqrt(GRAVITY * layer)
    return wp.min(wp.max(u * h / wp.max(layer, 1.0e-12), -critical), critical)


@wp.func
def wall_velocity(h: float, q: float, is_donor: bool) -> float:
    """Velocity of a column of depth `h` through which `q` [m2/s] passes; thin water gets it as a free jet."""
    speed = wp.abs(q) / wp.max(h, 1.0e-12)
    if not is_donor:
        speed = wp.min(speed, wp.pow(4.0 * GRAVITY * wp.abs(q), 1.0 / 3.0))
    return wp.where(q < 0.0, -speed, speed)


@wp.func
def weir_flux(
    l: side, r: side, z_step: float, rise_l: float, rise_r: float, coefficient: float, dt_dx: float
) -> wp.vec4:
    """Flux over a wall, in the form of `face_flux`.

    Args:
        l: state on the left.
        r: state on the right.
        z_step: bed of the right cell less that of the left [m].
        rise_l: crest above the bed of the left cell [m].
        rise_r: crest above the bed of the right cell [m].
        coefficient: C of the weir [m^0.5/s].
        dt_dx: dt / dx [s/m].
    """
    step = z_step + (r[3] - l[3])
    top_l = wp.max(rise_l - l[3], wp.max(step, 0.0))
    top_r = wp.max(rise_r - r[3], wp.max(-step, 0.0))
    hs_l = wp.max(l[0] - top_l, 0.0)
    hs_r = wp.max(r[0] - top_r, 0.0)
    if wp.abs(hs_l - hs_r) <= FACE_TOLERANCE * wp.max(l[0], r[0]):
        hs_l = wp.min(hs_l, hs_r)
        hs_r = hs_l
    us_l = over_crest(l[0], l[1], hs_l)
    us_r = over_crest(r[0], r[1], hs_r)
    riemann = level_flux(hs_l, us_l, l[4], hs_r, us_r, r[4], dt_dx)[0]
    way = wp.where(hs_l > hs_r, 1.0, wp.where(hs_l < hs_r, -1.0, 0.0))
    high = wp.max(hs_l, hs_r)
    ratio = wp.min(hs_l, hs_r) / wp.max(high, 1.0e-12)
    submerged = wp.pow(1.0 - ratio * wp.sqrt(ratio), 0.385)
    weir = dt_dx * coefficient * high * wp.sqrt(high) * submerged
    hindered = way * wp.min(weir, wp.max(way * riemann, 0.0))
    height = wp.min(top_l, top_r) / wp.max(LOW_SILL * wp.max(l[0], r[0]), 1.0e-12)
    height = wp.min(height, 1.0)
    mass = riemann + height * height * (hindered - riemann)
    mass = wp.max(wp.min(mass, dt_dx * l[6]), -dt_dx * r[7])
    # Whole floats, as in `face_flux`.
    anchor = 2.0 * wp.max(l[5], r[5])
    donor = wp.where(mass < 0.0, r[5], l[5])
    moved = wp.abs(mass)
    moved = wp.where(donor > 0.01 * anchor, moved, wp.max(moved - LAST_PLACE * anchor, 0.0))
    moved = (moved + anchor) - anchor
    mass = wp.where(mass < 0.0, -moved, moved)

    q = mass / dt_dx
    w_l = wall_velocity(l[0], q, q > 0.0)
    w_r = wall_velocity(r[0], q, q < 0.0)
    wall_l = level_flux(l[0], l[1], l[4], l[0], 2.0 * w_l - l[1], l[4], dt_dx)
    wall_r = level_flux(r[0], 2.0 * w_r - r[1], r[4], r[0], r[1], r[4], dt_dx)
    return wp.vec4(
        mass,
        wall_l[1] + (mass - wall_l[0]) / dt_dx * w_l,
        wall_r[2] + (mass - wall_r[0]) / dt_dx * w_r,
        q * wp.where(mass < 0.0, r[2], l[2]),
    )


@wp.func
def side_flux(
    f: Fields, s: Scheme, l: prediction, r: prediction, i_l: int, j_l: int, is_x: bool, wall: int,
    crests: wp.array(dtype=wp.float32), coefficients: wp.array(dtype=wp.float32),
    between: wp.array(dtype=wp.int32), dt_dx: float,
) -> wp.vec4:  # fmt: skip
    """Flux through the face right of padded cell (i_l, j_l): over wall number `wall`, plain if that is -1."""
    i_r = i_l
    j_r = j_l + 1
    if not is_x:
        i_r = i_l + 1
        j_r = j_l
    z_step = f.z[i_r, j_r] - f.z[i_l, j_l]
    if wall < 0:
        if is_x:
            return flux_x(l, r, z_step, dt_dx, s.contact)
        return flux_y(l, r, z_step, dt_dx, s.contact)
    bits = between[wall]
    left = side_state(
        l, f.h[i_l, j_l], f.u[i_l, j_l], f.v[i_l, j_l], is_x, 1.0, (bits & LEFT_IS_BETWEEN) != 0
    )
    right = side_state(
        r, f.h[i_r, j_r], f.u[i_r, j_r], f.v[i_r, j_r], is_x, -1.0, (bits & RIGHT_IS_BETWEEN) != 0
    )
    rise_l = crests[wall] - f.z[i_l, j_l]
    rise_r = crests[wall] - f.z[i_r, j_r]
    return weir_flux(left, right, z_step, rise_l, rise_r, coefficients[wall], dt_dx)


@wp.func
def remember(f: Fields, i: int, j: int, c: int, kept: wp.array2d(dtype=wp.float32)):
    """Copy the maxima of padded cell (i, j) to row `c`."""
    kept[c, 0] = f.h_max[i, j]
    kept[c, 1] = f.h_max_time[i, j]
    kept[c, 2] = f.speed_max[i, j]
    kept[c, 3] = f.discharge_max[i, j]
    kept[c, 4] = f.hazard_max[i, j]
    kept[c, 5] = f.arrival[i, j]
    kept[c, 6] = f.wet_since[i, j]
    kept[c, 7] = f.rise_rate_max[i, j]
    for n in range(f.class_depths.shape[0]):
        kept[c, KEPT_LENGTH + n] = f.class_arrival[n, i, j]


@wp.kernel(module=STRUCTURE_MODULE)
def remember_maxima(
    f: Fields,
    cells: wp.array2d(dtype=wp.int32),
    # outputs
    kept: wp.array2d(dtype=wp.float32),
):
    """Copy the maxima of the cells beside walls.

    Args:
        f: rasters.
        cells: [cells, CELL_LENGTH], see the constants.
        kept: [cells, 8 + depth classes].
    """
    c = wp.tid()
    remember(f, cells[c, ROW], cells[c, COL], c, kept)


@wp.kernel(module=STRUCTURE_MODULE)
def step_beside_weirs(
    f: Fields,
    s: Scheme,
    clock: wp.array(dtype=wp.float64),
    active: wp.array(dtype=wp.int32),
    cells: wp.array2d(dtype=wp.int32),
    crests: wp.array(dtype=wp.float32),
    coefficients: wp.array(dtype=wp.float32),
    between: wp.array(dtype=wp.int32),
    # outputs
    kept: wp.array2d(dtype=wp.float32),
):
    """Step the cells beside walls anew; those in tiles that sleep stay.

    Args:
        f: rasters; the flux step has just gone from `h` to `h_out`.
        s: scheme.
        clock: see `clock_kernels`.
        active: 1 for tiles that were computed.
        cells: [cells, CELL_LENGTH], see the constants.
        crests: crest of each wall [m].
        coefficients: C of each wall [m^0.5/s].
        between: bits of each wall, see the constants.
        kept: maxima before the step, [cells, 8 + depth classes]; afterwards those after it.
    """
    c = wp.tid()
    dt = wp.float32(clock[CLOCK_DT])
    stable = wp.float32(clock[CLOCK_STABLE])
    time = wp.float32(clock[CLOCK_TIME])
    i = cells[c, ROW]
    j = cells[c, COL]
    east = cells[c, EAST]
    west = cells[c, WEST]
    north = cells[c, NORTH]
    south = cells[c, SOUTH]
    if dt <= 0.0 or active[cells[c, TILE_NUMBER]] == 0:
        return
    deepest = wp.max(f.h[i, j], wp.max(f.h[i, j - 1], f.h[i, j + 1]))
    deepest = wp.max(deepest, wp.max(f.h[i - 1, j], f.h[i + 1, j]))
    if deepest <= s.depth_film:  # nothing moves, wall or no wall
        remember(f, i, j, c, kept)
        return
    half_dt = 0.5 * dt
    r = dt / s.dx
    p = predict_at(f, s, i, j, half_dt)
    p_e = predict_at(f, s, i, j + 1, half_dt)
    p_w = predict_at(f, s, i, j - 1, half_dt)
    p_n = predict_at(f, s, i + 1, j, half_dt)
    p_s = predict_at(f, s, i - 1, j, half_dt)
    e = side_flux(f, s, p, p_e, i, j, True, east, crests, coefficients, between, r)
    w = side_flux(f, s, p_w, p, i, j - 1, True, west, crests, coefficients, between, r)
    n = side_flux(f, s, p, p_n, i, j, False, north, crests, coefficients, between, r)
    b = side_flux(f, s, p_s, p, i - 1, j, False, south, crests, coefficients, between, r)
    e_x = wp.where(east >= 0 and west >= 0, 0.0, p[3] + p[6])
    e_y = wp.where(north >= 0 and south >= 0, 0.0, p[7] + p[10])
    q = update_cell(
        f.h[i, j], f.u[i, j], f.v[i, j], p[0], e_x, e_y,
        e[0], e[1], e[3], w[0], w[2], w[3],
        n[0], n[1], n[3], b[0], b[2], b[3],
        f.drag[i, j], dt, s.dx, s.depth_dry, s.depth_cfl, film_speed(s.courant, s.depth_cfl, stable),
    )  # fmt: skip
    m = widen_maxima(
        q[0], q[1], q[2], q[3], f.h[i, j], dt, time, s.depth_arrival,
        kept[c, 0], kept[c, 1], kept[c, 2], kept[c, 3], kept[c, 4], kept[c, 5], kept[c, 6], kept[c, 7],
    )  # fmt: skip
    f.h_out[i, j] = q[0]
    f.u_out[i, j] = q[1]
    f.v_out[i, j] = q[2]
    keep_maxima(f, i, j, m)
    for k in range(f.class_depths.shape[0]):
        f.class_arrival[k, i, j] = arrival_time(q[0], f.class_depths[k], time, kept[c, KEPT_LENGTH + k])
    remember(f, i, j, c, kept)
