"""The second-order scheme that the open literature compares with, as a yardstick: FullSWOF_2D in float64.

Source: Audusse, Bouchut, Bristeau, Klein and Perthame (2004), SIAM J. Sci. Comput. 25, 2050-2065
(hydrostatic reconstruction, second order); Delestre et al. (2017), FullSWOF, J. Open Source Software 2(20),
448. Minmod slopes of h, h + z_b, u and v, with velocities that keep the cell's momentum; HLL flux; Heun's
method; walls on all edges.

Along one direction, with the slopes D of a cell (i) and hydrostatic depths h* at the face z* = max(z_l,
z_r)::

    h_l = h + Dh/2,  z_l = z + (D(h+z) - Dh)/2,  u_l = u + h_r/h Du/2,     h* = max(h + z - z*, 0)
    d(hu)/dt = -(F(U*_l, U*_r) + g/2 (h^2 - h*^2))_faces / dx - g (h_r + h_l)/2 (z_l - z_r) / dx

It is written for clearness, not for speed; the tests run it on the same grids as the solver.
"""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
GRAVITY = 9.81
DEPTH_DRY = 1e-6
CFL = 0.45


def _minmod(a: Array, b: Array) -> Array:
    return np.where(a * b > 0.0, np.sign(a) * np.minimum(np.abs(a), np.abs(b)), 0.0)


def _slope(q: Array) -> Array:
    return _minmod(q[:, 1:-1] - q[:, :-2], q[:, 2:] - q[:, 1:-1])


def _hll(hl: Array, ul: Array, vl: Array, hr: Array, ur: Array, vr: Array) -> tuple[Array, Array, Array]:
    cl, cr = np.sqrt(GRAVITY * hl), np.sqrt(GRAVITY * hr)
    sl = np.minimum(np.minimum(ul - cl, ur - cr), 0.0)
    sr = np.maximum(np.maximum(ul + cl, ur + cr), 0.0)
    width = np.maximum(sr - sl, 1e-12)

    def flux(left: Array, right: Array, jump: Array) -> Array:
        return (sr * left - sl * right + sl * sr * jump) / width

    ql, qr = hl * ul, hr * ur
    push_l, push_r = 0.5 * GRAVITY * hl * hl, 0.5 * GRAVITY * hr * hr
    return (
        flux(ql, qr, hr - hl),
        flux(ql * ul + push_l, qr * ur + push_r, qr - ql),
        flux(ql * vl, qr * vr, hr * vr - hl * vl),
    )


def rate_along_x(h: Array, u: Array, v: Array, z: Array, dx: float | Array) -> tuple[Array, Array, Array]:
    """Rates of h, hu and hv from the fluxes along the second axis, on which two ghosts stand at each end."""
    dh, dw, du, dv = (0.5 * _slope(q) for q in (h, h + z, u, v))
    h, u, v, z = (q[:, 1:-1] for q in (h, u, v, z))
    dz = dw - dh
    he, hw = h + dh, h - dh
    depth = np.maximum(h, DEPTH_DRY)
    # Left and right states of each face.
    hl, zl, ul, vl = (q[:, :-1] for q in (he, z + dz, u + hw / depth * du, v + hw / depth * dv))
    hr, zr, ur, vr = (q[:, 1:] for q in (hw, z - dz, u - he / depth * du, v - he / depth * dv))
    face = np.maximum(zl, zr)
    hls, hrs = np.maximum(hl + zl - face, 0.0), np.maximum(hr + zr - face, 0.0)
    mass, normal, tangent = _hll(hls, ul, vl, hrs, ur, vr)
    leaving = normal + 0.5 * GRAVITY * (hl * hl - hls * hls)
    entering = normal + 0.5 * GRAVITY * (hr * hr - hrs * hrs)
    source = -GRAVITY * (he + hw)[:, 1:-1] * dz[:, 1:-1]
    return (
        (mass[:, :-1] - mass[:, 1:]) / dx,
        (entering[:, :-1] - leaving[:, 1:] + source) / dx,
        (tangent[:, :-1] - tangent[:, 1:]) / dx,
    )


def _between_walls(h: Array, u: Array, v: Array, z: Array, dx: float) -> tuple[Array, Array, Array]:
    """The rates with ghosts that mirror the water."""
    h, u, v, z = (np.pad(q, ((0, 0), (2, 2)), mode="symmetric") for q in (h, u, v, z))
    u[:, :2] *= -1.0
    u[:, -2:] *= -1.0
    return rate_along_x(h, u, v, z, dx)


def dragged(state: Array, u: Array, v: Array, drag: float | Array, dt: float | Array) -> Array:
    """Depth and discharge after Manning friction with ``drag`` g n^2, at the velocity of before the step."""
    slowing = 1.0 + dt * drag * np.hypot(u, v) * np.maximum(state[0], DEPTH_DRY) ** (-4.0 / 3.0)
    return state / np.array([np.ones(slowing.shape), slowing, slowing])


def velocity(h: Array, q: Array) -> Array:
    """Velocity [m/s] from depth and discharge; none where it is dry."""
    return np.where(h > DEPTH_DRY, q / np.maximum(h, DEPTH_DRY), 0.0)


def positive(state: Array) -> Array:
    """Depth and discharge without negative depths."""
    film = np.array([np.maximum(state[0], 0.0), 0.0 * state[0], 0.0 * state[0]])
    return np.where(state[0] > DEPTH_DRY, state, film)


def simulate(
    bed: Array, dx: float, h: Array, u: Array, v: Array, until: float, manning_n: float = 0.0
) -> tuple[Array, Array, Array]:
    """Advance depth [m] and velocity [m/s] on cells of ``dx`` [m] to the time ``until`` [s]."""
    drag = GRAVITY * manning_n**2

    def step(state: Array, dt: float) -> Array:
        h, u, v = state[0], velocity(state[0], state[1]), velocity(state[0], state[2])
        mass, along, across = _between_walls(h, u, v, bed, dx)
        mass_y, along_y, across_y = (q.T for q in _between_walls(h.T, v.T, u.T, bed.T, dx))
        moved = positive(state + dt * np.array([mass + mass_y, along + across_y, across + along_y]))
        return dragged(moved, u, v, drag, dt) if drag else moved

    state, time = np.array([h, h * u, h * v], dtype=np.float64), 0.0
    while time < until:
        fastest = max(
            float((np.abs(velocity(state[0], q)) + np.sqrt(GRAVITY * state[0])).max()) for q in state[1:]
        )
        dt = min(CFL * dx / fastest, until - time)
        state = positive(0.5 * (state + step(step(state, dt), dt)))
        time += dt
    return state[0], velocity(state[0], state[1]), velocity(state[0], state[2])
