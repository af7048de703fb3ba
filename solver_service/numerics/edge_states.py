"""The water at an edge, from the water inside and what is known outside.

Seen along the outward normal, the cell at the edge has depth h, velocity u and celerity c = sqrt(g h). What
leaves the grid carries the Riemann invariant u + 2 c outwards, so that the state (h_b, u_b) at the edge obeys

    u_b + 2 c_b = u + 2 c                                                             (subcritical flow)

and one more condition, by kind:

    open          u_b - 2 c_b = u_0 - 2 c_0, the invariant of the water that stood there at the start
    stage         h_b = level - z_b
    discharge     h_b u_b = -q              ->   2 c_b^3 - (u + 2 c) c_b^2 - g q = 0      (q inwards)
    normal_depth  u_b = h_b^(2/3) sqrt(S) / n

Flow that leaves faster than waves (u >= c) takes no condition: the state is that of the cell. Where the
condition asks for outflow faster than waves the edge is a free overfall, u_b = c_b = (u + 2 c) / 3; inflow
is never faster than waves, u_b >= -c_b. Differences are formed first, so that still water that agrees with
the condition gives exactly itself.

The tangential velocity leaves with the water; water that enters has none.

Sources: [Toro2001], [Blayo2005], [Sanders2002].
"""

import warp as wp

from solver_service.numerics.friction import GRAVITY
from solver_service.numerics.riemann import FACE_TOLERANCE

EDGE_WALL = wp.constant(0)
EDGE_OPEN = wp.constant(1)
EDGE_STAGE = wp.constant(2)
EDGE_DISCHARGE = wp.constant(3)
EDGE_NORMAL_DEPTH = wp.constant(4)

DISCHARGE_LEAST = wp.constant(1.0e-9)
"""Discharge per width that counts as none [m2/s]."""

NEWTON_STEPS = wp.constant(10)
"""From the chosen beginnings Newton's method falls monotonically; float32 is reached in fewer."""

PASSES = wp.constant(0.0)
"""Water passes the edge, and waves come back from it."""

ACTS_AS_WALL = wp.constant(1.0)
"""The edge reflects."""

FALLS_OFF = wp.constant(2.0)
"""The water leaves at least as fast as waves."""

edge_state = wp.types.vector(length=3, dtype=wp.float32)
"""h_b, u_b outwards, and one of the words above."""


@wp.func
def wall_state() -> edge_state:
    """The edge reflects."""
    return edge_state(0.0, 0.0, ACTS_AS_WALL)


@wp.func
def overfall(u: float, c: float) -> edge_state:
    """Critical outflow; a wall where nothing reaches the edge."""
    critical = (u + 2.0 * c) / 3.0
    state = wall_state()
    if critical > 0.0:
        state = edge_state(critical * critical / GRAVITY, critical, FALLS_OFF)
    return state


@wp.func
def open_state(h: float, u: float, rest_h: float, rest_u: float) -> edge_state:
    """Waves leave into water of depth `rest_h` that leaves with `rest_u`; nothing enters."""
    c = wp.sqrt(GRAVITY * h)
    state = edge_state(h, u, FALLS_OFF)
    if u <= 0.0 or u < c:
        state = edge_state(h, u, PASSES)
        rise = 2.0 * (wp.sqrt(GRAVITY * rest_h) - c)
        if wp.abs(rest_h - h) <= FACE_TOLERANCE * wp.max(h, rest_h):
            rise = 0.0
        dc = 0.25 * ((u - rest_u) + rise)
        u_b = u - 2.0 * dc
        if u_b > c + dc:
            state = overfall(u, c)
        elif u_b > 0.0:
            state = edge_state(h + dc * (2.0 * c + dc) / GRAVITY, u_b, PASSES)
        elif u != 0.0 or dc != 0.0:
            state = wall_state()
    return state


@wp.func
def stage_state(h: float, u: float, level_depth: float, rounding: float) -> edge_state:
    """The water outside stands `level_depth` above the bed, below zero when under it.

    `rounding` is that of the level [m]: two levels no further apart are the same.
    """
    c = wp.sqrt(GRAVITY * h)
    h_b = level_depth
    if wp.abs(h_b - h) <= wp.max(FACE_TOLERANCE * wp.max(h, h_b), rounding):
        h_b = h
    state = edge_state(h, u, FALLS_OFF)
    # A level above the sequent depth sends a jump against supercritical outflow.
    sequent = 0.5 * (wp.sqrt(h * h + 8.0 * h * u * u / GRAVITY) - h)
    if u <= 0.0 or u < c or h_b > sequent:
        c_b = wp.sqrt(GRAVITY * wp.max(h_b, 0.0))
        u_b = u + 2.0 * (c - c_b)
        if h_b <= 0.0 or u_b > c_b:
            state = overfall(u, c)
        else:
            state = edge_state(h_b, wp.max(u_b, -c_b), PASSES)
    return state


@wp.func
def inflow_celerity(invariant: float, q: float) -> float:
    """Celerity at which the discharge per width `q` > 0 enters against the outgoing invariant."""
    gq = GRAVITY * q
    critical = wp.pow(gq, 1.0 / 3.0)
    c = critical
    if invariant > critical:
        c = 0.5 * invariant + wp.pow(0.5 * gq, 1.0 / 3.0)
        for _ in range(NEWTON_STEPS):
            c = c - ((2.0 * c - invariant) * c * c - gq) / ((6.0 * c - 2.0 * invariant) * c)
        c = wp.max(c, critical)
    return c


@wp.func
def discharge_state(h: float, u: float, q: float) -> edge_state:
    """The discharge per width `q` enters, or leaves when negative and as far as there is water."""
    c = wp.sqrt(GRAVITY * h)
    invariant = u + 2.0 * c
    state = wall_state()
    if q > DISCHARGE_LEAST:
        c_b = inflow_celerity(invariant, q)
        state = edge_state(c_b * c_b / GRAVITY, -GRAVITY * q / (c_b * c_b), PASSES)
    elif q < -DISCHARGE_LEAST and invariant > 0.0:
        critical = invariant / 3.0
        gq = -GRAVITY * q
        if u > 0.0 and u >= c:
            state = edge_state(h, u, FALLS_OFF)
        elif gq >= critical * critical * critical:
            state = overfall(u, c)
        else:
            c_b = 0.5 * invariant
            for _ in range(NEWTON_STEPS):
                c_b = c_b - ((2.0 * c_b - invariant) * c_b * c_b + gq) / ((6.0 * c_b - 2.0 * invariant) * c_b)
            c_b = wp.max(c_b, critical)
            state = edge_state(c_b * c_b / GRAVITY, gq / (c_b * c_b), PASSES)
    return state


@wp.func
def normal_depth_state(h: float, u: float, drag: float, slope: float) -> edge_state:
    """The water leaves as uniform flow on the slope does; `drag` is g n^2 [m^(1/3)]."""
    c = wp.sqrt(GRAVITY * h)
    invariant = u + 2.0 * c
    state = wall_state()
    if u > 0.0 and u >= c:
        state = edge_state(h, u, FALLS_OFF)
    elif invariant > 0.0:
        # u_b = h_b^(2/3) sqrt(S) / n = k c_b^(4/3)
        k = wp.sqrt(GRAVITY * slope / wp.max(drag, 1.0e-12)) * wp.pow(GRAVITY, -2.0 / 3.0)
        c_b = 0.5 * invariant
        for _ in range(NEWTON_STEPS):
            root = wp.pow(c_b, 1.0 / 3.0)
            excess = k * c_b * root + 2.0 * c_b - invariant
            c_b = wp.max(c_b - excess / (4.0 / 3.0 * k * root + 2.0), 0.0)
        u_b = invariant - 2.0 * c_b
        if u_b > c_b:
            state = overfall(u, c)
        else:
            state = edge_state(c_b * c_b / GRAVITY, u_b, PASSES)
    return state
