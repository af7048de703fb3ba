"""The solver's own mathematics in float64, as a reference for its float32 state.

The step stands once, in the functions of `reconstruction`, `riemann`, `friction` and `conservative_update`
that Warp compiles for float32. Here the same Python text is run by NumPy: each function gets globals in which
``wp`` means NumPy on float64 arrays. What differs on purpose are the two tolerances that are float32 rounding
(they shrink by 2^-29, the ratio of the last places) and the cube root, which in float32 starts from a bit
pattern. Walls on all edges; no sources.
"""

from types import FunctionType, SimpleNamespace

import numpy as np
import warp as wp
from numpy.typing import NDArray

from solver_service.numerics import (
    FloodModel,
    SolverParams,
    conservative_update,
    friction,
    reconstruction,
    riemann,
)

Array = NDArray[np.float64]
LAST_PLACES = 2.0**-29

NUMPY = SimpleNamespace(
    abs=np.abs,
    max=np.maximum,
    min=np.minimum,
    sqrt=np.sqrt,
    where=np.where,
    vec4=lambda *values: values,
)


def in_float64() -> SimpleNamespace:
    """The functions of a step, rebound to NumPy."""
    names: dict[str, object] = {"wp": NUMPY, "prediction": NUMPY.vec4}
    for module in (friction, reconstruction, riemann, conservative_update):
        for name, value in vars(module).items():
            if isinstance(value, float):
                names[name] = value * LAST_PLACES if name.endswith("TOLERANCE") else value
            elif isinstance(value, wp.Function):
                names[name] = FunctionType(value.func.__code__, names, name)
    names["inverse_cube_root"] = lambda x: x ** (-1.0 / 3.0)
    return SimpleNamespace(**names)


STEP = in_float64()


def mirrored(field: Array, along_x: float = 1.0, along_y: float = 1.0) -> Array:
    """Two ghost cells behind walls on all sides; the signs turn a normal velocity round."""
    padded = np.pad(field, 2, mode="symmetric")
    padded[:, :2] *= along_x
    padded[:, -2:] *= along_x
    padded[:2] *= along_y
    padded[-2:] *= along_y
    return padded


def take_step(
    water: tuple[Array, Array, Array],
    z: Array,
    drag: Array,
    dx: float,
    dt: float,
    stable: float,
    params: SolverParams,
) -> tuple[Array, Array, Array]:
    """Depth [m] and velocity [m/s] after ``dt`` [s], ``stable`` [s] where it is not cut short to land.

    ``water`` is depth and velocity before; ``z`` and ``drag`` carry two ghost cells.
    """
    h, u, v = water
    ghosted = mirrored(h), mirrored(u, along_x=-1.0), mirrored(v, along_y=-1.0), z
    nrows, ncols = h.shape[0] + 2, h.shape[1] + 2

    def shifted(rows: int, cols: int) -> list[Array]:
        return [q[1 + rows : 1 + rows + nrows, 1 + cols : 1 + cols + ncols] for q in ghosted]

    second = float(params.order == 2)
    # h' u' v', half slopes of h u v z_b along x and along y, celerity, share, mixing: cells and one ring.
    p = STEP.predict(
        *shifted(0, 0), *shifted(0, -1), *shifted(0, 1), *shifted(-1, 0), *shifted(1, 0),
        drag[1:-1, 1:-1], 0.5 * dt, dx,
        params.limiter_theta * second, params.depth_dry, params.depth_film, second,
        params.eddy_viscosity,
    )  # fmt: skip
    contact = 1.0 if params.riemann == "hllc" else 0.0

    def fluxes(order: tuple[int, ...], before: tuple[slice, slice], behind: tuple[slice, slice]):
        step = z[1:-1, 1:-1][behind] - z[1:-1, 1:-1][before]
        sides = [p[k][side] for side in (before, behind) for k in order]
        return STEP.face_flux(*sides, step, dt / dx, contact)

    inner = slice(1, -1)
    x = fluxes((0, 3, 1, 4, 2, 5, 6, 11, 12, 13), (inner, slice(None, -1)), (inner, slice(1, None)))
    y = fluxes((0, 7, 2, 9, 1, 8, 10, 11, 12, 13), (slice(None, -1), inner), (slice(1, None), inner))
    west, east = [q[:, :-1] for q in x], [q[:, 1:] for q in x]
    south, north = [q[:-1] for q in y], [q[1:] for q in y]
    cell = [q[inner, inner] for q in p]
    h_new, u_new, v_new, _ = STEP.update_cell(
        h, u, v, cell[0], cell[3] + cell[6], cell[7] + cell[10],
        east[0], east[1], east[3], west[0], west[2], west[3],
        north[0], north[1], north[3], south[0], south[2], south[3],
        drag[2:-2, 2:-2], dt, dx, params.depth_dry, params.depth_cfl,
        STEP.film_speed(params.cfl * dx, params.depth_cfl, stable),
    )  # fmt: skip
    around = ghosted[0]
    deepest = np.maximum.reduce([
        h, around[2:-2, 1:-3], around[2:-2, 3:-1], around[1:-3, 2:-2], around[3:-1, 2:-2],
    ])  # fmt: skip
    still = deepest <= params.depth_film
    return np.where(still, h, h_new), np.where(still, u, u_new), np.where(still, v, v_new)


def simulate(
    model: FloodModel, params: SolverParams, h: Array, u: Array, v: Array, until: float
) -> tuple[tuple[Array, Array, Array], int]:
    """Depth [m] and velocity [m/s] at ``until`` [s], and the number of steps, from time 0 within walls."""
    h, u, v = (np.asarray(q, np.float32).astype(np.float64) for q in (h, u, v))
    moving = h > params.depth_dry
    u, v = u * moving, v * moving
    n = np.broadcast_to(np.asarray(model.manning_n, np.float64), model.shape)
    z = np.pad(model.z_b.astype(np.float64), 2, mode="symmetric")
    drag = np.pad(STEP.GRAVITY * n**2, 2, mode="symmetric")
    time, steps = 0.0, 0
    while time < until:
        wave = float((np.maximum(np.abs(u), np.abs(v)) + np.sqrt(STEP.GRAVITY * h)).max())
        stable, left = params.cfl * model.dx / wave, until - time
        dt = stable
        if dt >= left:
            dt = left
        elif 2.0 * dt > left:
            dt = 0.5 * left
        h, u, v = take_step((h, u, v), z, drag, model.dx, dt, stable, params)
        time, steps = (until if dt == left else time + dt), steps + 1
    return (h, u, v), steps
