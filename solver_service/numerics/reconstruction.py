"""Linear reconstruction and half-step prediction of a cell (MUSCL-Hancock).

Surface eta = h + z_b, bed z_b and velocities u, v are linear in a cell, with slopes limited by the
generalised minmod function. The slope of h is that of eta less that of the bed, cut where a face would get a
negative depth; there the bed gives way, so that a level surface stays level at every face. The bed has its
own slope: where h and eta are limited apart [Audusse2004] it is their difference and tilts with every ripple,
and near critical flow the balance of ripple and tilt can freeze to a saw-tooth of 4 % of the depth. The
primitive equations carry the cell to half time:

    h' = h - dt/2 (u h_x + h u_x + v h_y + h v_y)
    u' = [u - dt/2 (u u_x + v u_y + g eta_x)] / (1 + dt/2 g n^2 |u| h^(-4/3))          (v' alike)

A difference of eta between two cells is taken as (h_e - h_c) + (z_e - z_c) and counts as zero when it is no
larger than the rounding of the depths it is made of (`LEVEL_TOLERANCE`): a float32 lake at rest is then
exactly level, and nothing that float32 depths can express is lost. A cell no deeper than `depth_dry`
carries no momentum and has no slopes.

Turbulence exchanges momentum between streams that pass each other, with the eddy viscosity nu = c u* h;
u* = |u| sqrt(g n^2 h^(-1/3)) is the friction velocity, and c = 6 has the size of Elder's 5.93 [Elder1959].
A cell offers to mix h nu / dx over a face (`mixing`, see `riemann`). Without it jets beside the banks of a
gorge do not spread: at Malpasset the water then stands 12 m above the first observed mark, with it 0.4 m.
Normal stresses are left out: along the flow they would blur the front of a dam break on a rough bed, whose
error they raise by 60 %. nu is limited to 0.1 dx^2 / dt, less than half of what an explicit step allows.

The depth that leaves through the four faces in one step must not exceed h. The flux that a face may draw
from its donor is capped by a share of its depth that the donor alone decides (`share`): with the outflow
bounds B_f = h_f max(u_f + c, 0) of its faces, face f may draw share B_f, share = min(1, 0.999 h dx / (dt
sum B_f)). This is a draining limiter in the spirit of the draining time step [Bollermann2011],
[Horvath2015], without a second stencil. In smooth flow no cap is reached.

Sources: [Toro2001] ch. 10 and 14, [Audusse2004], [Kurganov2007].
"""

import warp as wp

from solver_service.numerics.friction import GRAVITY, inverse_cube_root

LEVEL_TOLERANCE = wp.constant(1.5e-7)
"""Difference of eta between neighbours that counts as none, in units of the larger depth [1].

Rounding alone gives less than 2^-23 = 1.2e-7. A larger tolerance would hold small slopes fast: with 4.8e-7
the measured order in smooth flow falls from 1.96 to 1.78.
"""

MIXING_LIMIT = wp.constant(0.1)
"""Largest eddy viscosity in units of dx^2 / dt [1]."""

DRAIN_LIMIT = wp.constant(0.999)
"""Part of a cell's water that may leave in one step [1]; the rest is room for rounding."""

prediction = wp.types.vector(length=14, dtype=wp.float32)
"""h' u' v', half slopes h u v z_b along x, the same along y, celerity, share of the outflow bound,
mixing."""


@wp.func
def limited_slope(backward: float, forward: float, theta: float) -> float:
    """Generalised minmod of two one-sided differences; theta 1 is minmod, 2 is MC, 0 is first order."""
    central = 0.5 * (backward + forward)
    a = theta * backward
    b = theta * forward
    return wp.max(0.0, wp.min(wp.min(a, b), central)) + wp.min(0.0, wp.max(wp.max(a, b), central))


@wp.func
def surface_step(h_a: float, h_b: float, z_a: float, z_b: float) -> float:
    """eta_b - eta_a [m], zero when it is rounding."""
    step = (h_b - h_a) + (z_b - z_a)
    return wp.where(wp.abs(step) <= LEVEL_TOLERANCE * wp.max(h_a, h_b), 0.0, step)


@wp.func
def predict(
    h: float,
    u: float,
    v: float,
    z: float,
    h_w: float,
    u_w: float,
    v_w: float,
    z_w: float,
    h_e: float,
    u_e: float,
    v_e: float,
    z_e: float,
    h_s: float,
    u_s: float,
    v_s: float,
    z_s: float,
    h_n: float,
    u_n: float,
    v_n: float,
    z_n: float,
    drag: float,
    half_dt: float,
    dx: float,
    theta: float,
    depth_dry: float,
    depth_film: float,
    hancock: float,
    eddy: float,
) -> prediction:
    """State at half time, half slopes and outflow share of a cell from itself and its four neighbours.

    `drag` is g n^2 [m^(1/3)], `hancock` is 1 for second order in time and 0 for none, `eddy` c in
    c u* h.
    """
    t = wp.where(h > depth_dry, theta, 0.0)
    u_x = limited_slope(u - u_w, u_e - u, t)
    v_x = limited_slope(v - v_w, v_e - v, t)
    e_x = limited_slope(surface_step(h_w, h, z_w, z), surface_step(h, h_e, z, z_e), t)
    h_x = wp.max(wp.min(e_x - limited_slope(z - z_w, z_e - z, t), 2.0 * h), -2.0 * h)
    u_y = limited_slope(u - u_s, u_n - u, t)
    v_y = limited_slope(v - v_s, v_n - v, t)
    e_y = limited_slope(surface_step(h_s, h, z_s, z), surface_step(h, h_n, z, z_n), t)
    h_y = wp.max(wp.min(e_y - limited_slope(z - z_s, z_n - z, t), 2.0 * h), -2.0 * h)

    k = hancock * half_dt / dx
    root = inverse_cube_root(wp.max(h, depth_dry))
    speed = wp.sqrt(u * u + v * v)
    decay = drag * ((root * root) * (root * root)) * speed
    damping = 1.0 / (1.0 + hancock * half_dt * decay)
    h_p = wp.max(h - k * ((u * h_x + h * u_x) + (v * h_y + h * v_y)), 0.0)
    u_p = (u - k * ((u * u_x + v * u_y) + GRAVITY * e_x)) * damping
    v_p = (v - k * ((u * v_x + v * v_y) + GRAVITY * e_y)) * damping

    z_x = 0.5 * (e_x - h_x)
    z_y = 0.5 * (e_y - h_y)
    h_x = wp.max(wp.min(0.5 * h_x, h_p), -h_p)
    h_y = wp.max(wp.min(0.5 * h_y, h_p), -h_p)
    u_x = 0.5 * u_x
    u_y = 0.5 * u_y
    v_x = 0.5 * v_x
    v_y = 0.5 * v_y

    u_star = speed * wp.sqrt(drag * root)
    mixing = h * wp.min(eddy * h * u_star / dx, (0.5 * MIXING_LIMIT) * dx / half_dt)
    c = wp.sqrt(GRAVITY * h)
    out_e = (h_p + h_x) * wp.max((u_p + u_x) + c, 0.0)
    out_w = (h_p - h_x) * wp.max((u_x - u_p) + c, 0.0)
    out_n = (h_p + h_y) * wp.max((v_p + v_y) + c, 0.0)
    out_s = (h_p - h_y) * wp.max((v_y - v_p) + c, 0.0)
    outflow = 2.0 * half_dt * ((out_e + out_w) + (out_n + out_s))
    share = wp.min(1.0, DRAIN_LIMIT * h * dx / wp.max(outflow, 1.0e-12))
    share = wp.where(h > depth_film, share, 0.0)
    return prediction(h_p, u_p, v_p, h_x, u_x, v_x, z_x, h_y, u_y, v_y, z_y, c, share, mixing)
