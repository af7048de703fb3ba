"""New state of a cell from its face fluxes, and the largest values seen.

    h'  = h - dt/dx (F_e - F_w + G_n - G_s)                                (the faces give depths, dt/dx F)
    hu' = hu - dt/dx (F_e - F_w + G_n - G_s + g h (eta_e - eta_w))           (hv' alike), then friction

The momentum fluxes are relative to the cell's own pressure (see `riemann`), so what remains of pressure and
bed slope inside the cell is g h (eta_e - eta_w), exactly zero when the reconstructed surface is level.

The time a cell has been wet is kept as one number that changes only when the cell gets wet or dry, so that
nothing is summed up and cells that sleep need no care: the time in all while it is dry, and -(1 + s) while it
is wet, where s is now less the time in all.

Hazard is the UK rating HR = h (|u| + 0.5) + DF, DF = 0.5 for h <= 0.25 m, else 1 [Defra2006]; speeds count
for the maxima only where h > 0.05 m.
"""

import warp as wp

from solver_service.numerics.friction import GRAVITY, friction_factor

DEPTH_SPEED_COUNTS = wp.constant(0.05)
"""Depth above which a speed counts for the maxima [m]."""

maxima = wp.types.vector(length=9, dtype=wp.float32)
"""h, time of it, speed, h speed, hazard, arrival time, wave speed, wet since, rate of rise."""


@wp.func
def film_speed(courant: float, depth_cfl: float, stable: float) -> float:
    """Speed along x or y [m/s] with which water as deep as `depth_cfl` asks for no step shorter than it is.

    `courant` is cfl dx [m]; `stable` is the step that stability allows [s], not the one cut short to land.
    """
    return wp.max(courant / stable - wp.sqrt(GRAVITY * depth_cfl), 0.0)


@wp.func
def limited(x: float, most: float) -> float:
    """X within -most and most; what is not a number stays so (min and max would hide it)."""
    return wp.where(x > most, most, wp.where(x < -most, -most, x))


@wp.func
def update_cell(
    h: float,
    u: float,
    v: float,
    h_p: float,
    e_x: float,
    e_y: float,
    mass_e: float,
    normal_e: float,
    tangential_e: float,
    mass_w: float,
    normal_w: float,
    tangential_w: float,
    mass_n: float,
    normal_n: float,
    tangential_n: float,
    mass_s: float,
    normal_s: float,
    tangential_s: float,
    drag: float,
    dt: float,
    dx: float,
    depth_dry: float,
    depth_cfl: float,
    film_speed: float,
) -> wp.vec4:
    """Depth, velocities and speed after the step.

    `e_x`, `e_y` are half the differences of eta inside the cell [m]; `drag` is g n^2 [m^(1/3)]. Water no
    deeper than `depth_cfl` is no faster than `film_speed` along x or y.
    """
    r = dt / dx
    h_new = h - ((mass_e - mass_w) + (mass_n - mass_s))
    pull = 2.0 * GRAVITY * h_p
    hu = h * u - r * (((normal_e - normal_w) + (tangential_n - tangential_s)) + pull * e_x)
    hv = h * v - r * (((tangential_e - tangential_w) + (normal_n - normal_s)) + pull * e_y)
    h_floor = wp.max(h_new, depth_dry)
    inverse = 1.0 / h_floor
    u_free = hu * inverse
    v_free = hv * inverse
    speed = wp.sqrt(u_free * u_free + v_free * v_free)
    factor = friction_factor(h_floor, speed, drag, dt)
    fastest = wp.where(h_new > depth_cfl, 1.0e30, film_speed)
    fastest = wp.where(h_new > depth_dry, fastest, 0.0)
    return wp.vec4(
        h_new,
        limited(u_free * factor, fastest),
        limited(v_free * factor, fastest),
        limited(speed * factor, fastest),
    )


@wp.func
def arrival_time(h: float, depth: float, time: float, arrival: float) -> float:
    """First time deeper than `depth` [s]."""
    return wp.where(h > depth, wp.min(arrival, time), arrival)


@wp.func
def widen_maxima(
    h: float,
    u: float,
    v: float,
    speed: float,
    h_before: float,
    dt: float,
    time: float,
    depth_arrival: float,
    h_max: float,
    h_max_time: float,
    speed_max: float,
    discharge_max: float,
    hazard_max: float,
    arrival: float,
    wet_since: float,
    rise_rate_max: float,
) -> maxima:
    """Maxima that take in a new state; the wave speed is huge where the state is not finite."""
    arrived = h > depth_arrival
    counted = wp.where(h > DEPTH_SPEED_COUNTS, speed, 0.0)
    hazard = h * (counted + 0.5) + wp.where(h > 0.25, 1.0, 0.5)
    hazard = wp.where(arrived, hazard, 0.0)
    rise_rate = wp.where(arrived, (h - h_before) * (1.0 / dt), 0.0)
    turned = wp.where(arrived, (wet_since - time) - 1.0, (wet_since + time) + 1.0)
    wave = wp.max(wp.abs(u), wp.abs(v)) + wp.sqrt(GRAVITY * h)
    return maxima(
        wp.max(h_max, h),
        wp.where(h > h_max, time, h_max_time),
        wp.max(speed_max, counted),
        wp.max(discharge_max, h * counted),
        wp.max(hazard_max, hazard),
        arrival_time(h, depth_arrival, time, arrival),
        wp.where(wave + speed < 1.0e30, wave, 3.0e38),
        wp.where(arrived == (wet_since < 0.0), wet_since, turned),
        wp.max(rise_rate_max, rise_rate),
    )
