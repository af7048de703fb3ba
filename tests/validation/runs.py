"""Grids, one run of the solver under test, and the error norms that all cases share."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from solver_service.numerics import FloodModel, ShallowWaterSolver, SolverParams
from tests.validation import published_scheme

Array = NDArray[np.float64]
State = tuple[Array, Array, Array]


@dataclass(frozen=True)
class Grid:
    """Cells of ``dx`` [m], ``nrows`` x ``ncols``, with the south-western corner at (x0, y0) [m]."""

    nrows: int
    ncols: int
    dx: float
    x0: float
    y0: float

    @property
    def centres(self) -> tuple[Array, Array]:
        """Coordinates x and y of the cell centres [m], each [nrows, ncols]."""
        x = self.x0 + (np.arange(self.ncols) + 0.5) * self.dx
        y = self.y0 + (np.arange(self.nrows) + 0.5) * self.dx
        grid_x, grid_y = np.meshgrid(x, y)
        return grid_x, grid_y


def square(cells: int, size: float) -> Grid:
    """A square of ``size`` [m] around the origin."""
    return Grid(cells, cells, size / cells, -0.5 * size, -0.5 * size)


def channel(cells: int, west: float, east: float, rows: int = 4) -> Grid:
    """A strip along x from ``west`` to ``east`` [m]."""
    return Grid(rows, cells, (east - west) / cells, west, 0.0)


def make_solver(bed: Array, dx: float, manning_n: float = 0.0, **params) -> ShallowWaterSolver:
    """The solver under test on a bed with walls on all edges."""
    model = FloodModel(dx=dx, z_b=bed.astype(np.float32), manning_n=manning_n)
    return ShallowWaterSolver(model, SolverParams(**params), device="cpu")


def solve(solution, grid: Grid, until: float, **params) -> State:
    """Start from an exact solution at time 0 and return depth and velocity at ``until`` [s] in float64."""
    x, y = grid.centres
    h, u, v = (q.astype(np.float32) for q in solution.state(x, y, 0.0))
    solver = make_solver(solution.bed(x, y), grid.dx, getattr(solution, "manning_n", 0.0), **params)
    solver.set_water(h, u, v)
    solver.advance_to(until)
    u, v = solver.velocity()
    return tuple(q.astype(np.float64) for q in (solver.depth(), u, v))


def solve_published(solution, grid: Grid, until: float) -> State:
    """The same run with the published scheme."""
    x, y = grid.centres
    manning_n = getattr(solution, "manning_n", 0.0)
    return published_scheme.simulate(
        solution.bed(x, y), grid.dx, *solution.state(x, y, 0.0), until, manning_n=manning_n
    )


def discharge(state: State) -> Array:
    """Both components of the unit discharge [m2/s]."""
    h, u, v = state
    return np.array([h * u, h * v])


def l1(computed: Array, exact: Array) -> float:
    """Mean absolute error."""
    return float(np.abs(computed - exact).mean())


def l2(computed: Array, exact: Array) -> float:
    """Root mean square error."""
    return float(np.sqrt(np.square(computed - exact).mean()))


def largest(computed: Array, exact: Array) -> float:
    """Largest absolute error."""
    return float(np.abs(computed - exact).max())


def order_of(errors: list[float]) -> float:
    """Observed order between the last two grids, each twice as fine as the one before."""
    return float(np.log2(errors[-2] / errors[-1]))


def errors(state: State, exact: State, deeper_than: float = 0.1) -> dict[str, float]:
    """Error norms of depth [m], unit discharge [m2/s] and velocity [m/s].

    Velocity is compared where the exact and the computed water are both deeper than ``deeper_than`` [m]: a
    thinner film moves nothing, and every threshold of a scheme shows in it.
    """
    wet = (exact[0] > deeper_than) & (state[0] > deeper_than)
    off = np.hypot(state[1] - exact[1], state[2] - exact[2])[wet]
    return {
        "L1 of h": l1(state[0], exact[0]),
        "L2 of h": l2(state[0], exact[0]),
        "Linf of h": largest(state[0], exact[0]),
        "L1 of the unit discharge": float(np.abs(discharge(state) - discharge(exact)).sum(axis=0).mean()),
        "L1 of the velocity": float(off.mean()),
    }
