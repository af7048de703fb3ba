"""Flux through a face: hydrostatic reconstruction and the HLL or HLLC solver, in deviation form.

Left and right state (depth h, bed z at the face) meet at the bed z_f of [ChenNoelle2017]:

    z_f = min(max(z_l, z_r), min(eta_l, eta_r)),   h*_l = min(eta_l - z_f, h_l),   h*_r likewise

which is [Audusse2004] wherever the bed step is under water, and keeps the full pull of gravity where thin
water runs over a step. With s_l <= 0 <= s_r (two-rarefaction estimate, exact speeds at a dry side
[Toro2001]), a = (s_r + s_l) / (s_r - s_l), b = s_l s_r / (s_r - s_l):

    F = (F_l + F_r) / 2 + a (F_l - F_r) / 2 + b (U_r - U_l)

This is HLL written so that it is exact for equal states and mirrors bit for bit. HLLC differs in the
tangential momentum alone, which the mass flux carries from the side it comes from.

Where the step rises above the level that the water would reach when reflected, (c + u/2)^2 / g, the face is
a wall [George2008]: mass flux and hydrostatic pressure come out of the above, and the impulse of the water
that runs into it, h u (u + s) with s the speed of the reflected wave, is added. Water that can climb the
step keeps its momentum: held back at every emergent step, the shore of Thacker's circling plane triples its
error.

Water is moved in whole floats: the depth dt/dx |F| that a face moves is rounded once, to the grid of floats
at twice the larger depth, so that what one cell gives and the other gets add to their depths without
rounding. Else a steady river, which rounds the same way in every step, loses 6e-6 of its water in 4500
steps; so it keeps it to 1e-9. What a cell much shallower than its neighbour gives is rounded down.

Streams that pass each other drag each other along: the tangential momentum flux has the shear stress of the
eddy viscosity (see `reconstruction`), the smaller of what the two cells offer, where water joins them.

Each cell takes the normal momentum flux relative to the pressure g h*^2 / 2 of its own side, plus the pull
g h min(z_f - z, 0) of a step. Together with g h (eta_e - eta_w) inside the cell this is the full balance of
pressure and bed slope (see `conservative_update`), and every term is exactly zero in a lake at rest: h*_l
and h*_r that differ by rounding only are set equal (`FACE_TOLERANCE`).
"""

import warp as wp

from solver_service.numerics.friction import GRAVITY

FACE_TOLERANCE = wp.constant(3.0e-7)
"""Difference of h*_l and h*_r that counts as none, in units of the larger cell depth [1].

Rounding alone gives less than 2^-22 = 2.4e-7 in a lake at rest; see also `LEVEL_TOLERANCE`.
"""

LAST_PLACE = wp.constant(1.2e-7)
"""A little more than the distance of a float to the next, in units of it [1]."""


@wp.func
def face_flux(
    h_l: float,
    h_l_slope: float,
    u_l_centre: float,
    u_l_slope: float,
    v_l_centre: float,
    v_l_slope: float,
    z_l_slope: float,
    c_l_cell: float,
    share_l: float,
    mixing_l: float,
    h_r: float,
    h_r_slope: float,
    u_r_centre: float,
    u_r_slope: float,
    v_r_centre: float,
    v_r_slope: float,
    z_r_slope: float,
    c_r_cell: float,
    share_r: float,
    mixing_r: float,
    z_step: float,
    dt_dx: float,
    contact: float,
) -> wp.vec4:
    """Depth moved to the right [m], normal momentum for the left and the right cell, tangential one.

    Arguments are cell values at half time with half slopes along the face normal (u normal, v tangential);
    `z_step` is z_b of the right cell less that of the left; `dt_dx` is in s/m; `contact` is 1 for HLLC and
    0 for HLL.
    """
    d_l = h_l + h_l_slope
    d_r = h_r - h_r_slope
    u_l = u_l_centre + u_l_slope
    u_r = u_r_centre - u_r_slope
    v_l = v_l_centre + v_l_slope
    v_r = v_r_centre - v_r_slope

    # z_f above the left and above the right bed; each from its own side, so that a dry side stays exactly dry
    # below any step and the face mirrors bit for bit.
    step = z_step - (z_l_slope + z_r_slope)
    rise_l = wp.min(wp.max(step, 0.0), wp.min(d_l, d_r + step))
    rise_r = wp.min(wp.max(-step, 0.0), wp.min(d_r, d_l - step))
    hs_l = wp.max(wp.min(d_l - rise_l, d_l), 0.0)
    hs_r = wp.max(wp.min(d_r - rise_r, d_r), 0.0)
    level = wp.abs(hs_r - hs_l) <= FACE_TOLERANCE * wp.max(h_l, h_r)
    hs_min = wp.min(hs_l, hs_r)
    hs_l = wp.where(level, hs_min, hs_l)
    hs_r = wp.where(level, hs_min, hs_r)

    c_l = wp.sqrt(GRAVITY * hs_l)
    c_r = wp.sqrt(GRAVITY * hs_r)
    u_mid = 0.5 * (u_l + u_r) + (c_l - c_r)
    c_mid = 0.5 * (c_l + c_r) + 0.25 * (u_l - u_r)
    s_l = wp.min(u_l - c_l, u_mid - c_mid)
    s_r = wp.max(u_r + c_r, u_mid + c_mid)
    dry_l = hs_l <= 0.0
    dry_r = hs_r <= 0.0
    s_l = wp.where(dry_r, u_l - c_l, wp.where(dry_l, u_r - 2.0 * c_r, s_l))
    s_r = wp.where(dry_l, u_r + c_r, wp.where(dry_r, u_l + 2.0 * c_l, s_r))
    s_l = wp.min(s_l, 0.0)
    s_r = wp.max(s_r, 0.0)
    inverse = 1.0 / wp.max(s_r - s_l, 1.0e-6)
    a = (s_r + s_l) * inverse
    b = s_l * s_r * inverse

    q_l = hs_l * u_l
    q_r = hs_r * u_r
    m_l = q_l * u_l
    m_r = q_r * u_r
    dh = hs_r - hs_l
    dp = 0.5 * GRAVITY * (dh * (hs_r + hs_l))
    mass_free = 0.5 * ((q_l + q_r) + a * (q_l - q_r)) + b * dh
    normal = 0.5 * ((m_l + m_r) + a * ((m_l - m_r) - dp)) + b * (q_r - q_l)

    cap_l = share_l * (d_l * wp.max(u_l + c_l_cell, 0.0))
    cap_r = share_r * (d_r * wp.max(c_r_cell - u_r, 0.0))
    mass = wp.max(wp.min(mass_free, cap_l), -cap_r)
    normal = normal + (mass - mass_free) * wp.where(mass < mass_free, u_l, u_r)

    # A bed step that the reflected water does not reach is a wall.
    climb_l = c_l_cell + 0.5 * wp.max(u_l, 0.0)
    climb_r = c_r_cell - 0.5 * wp.min(u_r, 0.0)
    ram_l = d_l * u_l * wp.max(u_l + wp.max(u_l + c_l_cell, 0.5 * u_l + c_l_cell), 0.0)
    ram_r = d_r * u_r * wp.min(u_r - wp.max(c_r_cell - u_r, c_r_cell - 0.5 * u_r), 0.0)

    carried = mass * wp.where(mass > 0.0, v_l, v_r)
    mixed = 0.5 * ((q_l * v_l + q_r * v_r) + a * (q_l * v_l - q_r * v_r)) + b * (hs_r * v_r - hs_l * v_l)
    tangential = wp.where(contact > 0.5, carried, mixed)

    mixing = wp.where(wp.min(hs_l, hs_r) > 0.0, wp.min(mixing_l, mixing_r), 0.0)
    tangential = tangential - mixing * (v_r_centre - v_l_centre)

    pull_l = GRAVITY * (d_l * wp.min(rise_l, 0.0)) + wp.where(GRAVITY * step >= climb_l * climb_l, ram_l, 0.0)
    pull_r = GRAVITY * (d_r * wp.min(rise_r, 0.0)) + wp.where(
        -GRAVITY * step >= climb_r * climb_r, ram_r, 0.0
    )
    normal_l = (normal + 0.5 * dp) + pull_l
    normal_r = (normal - 0.5 * dp) + pull_r
    # Rounds to a multiple of the last place of 2 max(h_l, h_r); mirrored faces round alike. A shallow donor
    # could not pay for what is rounded up: it gives what is rounded down.
    anchor = 2.0 * wp.max(h_l, h_r)
    donor = wp.where(mass < 0.0, h_r, h_l)
    moved = dt_dx * wp.abs(mass)
    moved = wp.where(donor > 0.01 * anchor, moved, wp.max(moved - LAST_PLACE * anchor, 0.0))
    moved = (moved + anchor) - anchor
    return wp.vec4(wp.where(mass < 0.0, -moved, moved), normal_l, normal_r, tangential)
