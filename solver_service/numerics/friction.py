"""Manning friction, semi-implicit.

    d(hu)/dt = -g n^2 |u| u h^(-1/3)

After the flux step has given velocity U*, the new one solves U + dt k |U| U = U* with k = g n^2 h^(-4/3), a
quadratic equation in |U|:

    U = 2 U* / (1 + sqrt(1 + 4 dt k |U*|))

Unconditionally stable, never turns the flow round, and exact for uniform flow (at a balance of slope and
friction U stays what it is). h^(-1/3) comes from a bit estimate and three Newton steps: pow would keep row
loops scalar.
"""

import warp as wp

GRAVITY = wp.constant(9.81)
"""Acceleration of gravity [m s-2]."""


@wp.func
def inverse_cube_root(x: float) -> float:
    """x^(-1/3) for a positive x, to float32 rounding."""
    y = wp.cast(wp.int32(1419967116) - wp.cast(x, wp.int32) / wp.int32(3), wp.float32)
    third = x * (1.0 / 3.0)
    y = y * ((4.0 / 3.0) - third * (y * y * y))
    y = y * ((4.0 / 3.0) - third * (y * y * y))
    y = y * ((4.0 / 3.0) - third * (y * y * y))
    return y


@wp.func
def friction_factor(h: float, speed: float, drag: float, dt: float) -> float:
    """Ratio of the velocity after friction to that before.

    `h` is the depth [m] (positive), `drag` g n^2 [m^(1/3)].
    """
    root = inverse_cube_root(h)
    k = drag * ((root * root) * (root * root))
    return 2.0 / (1.0 + wp.sqrt(1.0 + 4.0 * dt * k * speed))
