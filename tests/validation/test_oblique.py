"""Dam breaks at 30 and 45 degrees to the grid, and Thacker's basin with the water on a slanting side.

Sources: as for the cases along the grid (``test_ritter.py``, ``test_stoker.py``, ``test_dressler.py``,
``test_thacker.py``). A scheme that splits the directions, or whose limiter favours the axes, is worse off the
axes; here oblique water must be computed as well as water along the axes. The exact solutions know no
turbulence, so that the eddy viscosity is off, but for one figure: it mixes what the grid sees as shear, in a
stream at an angle also what is none.
"""

import numpy as np
import pytest

from solver_service.numerics import SolverParams
from tests.validation.published_scheme import simulate
from tests.validation.runs import Grid, l1, make_solver, solve, square
from tests.validation.solutions import Dressler, Ritter, Stoker, ThackerPlanar

DAMS = "Dam breaks at an angle to the grid, cells of 10 m, after 20 s"
BASIN = "Thacker: plane surface that starts at an angle to the grid"
SIZE, CELLS, TIME, FINER = 1600.0, 160, 20.0, 8
CLEAR = 0.5 * SIZE - 18.0 * TIME  # waves from the walls come in at less than 18 m/s
ANGLES = {"30 degrees": np.pi / 6.0, "45 degrees": np.pi / 4.0}
KINDS = {
    "dry bed": lambda angle: Ritter(10.0, angle=angle),
    "wet bed": lambda angle: Stoker(10.0, 1.0, angle=angle),
    "dry rough bed": lambda angle: Dressler(10.0, 0.02, angle=angle),
}
BOUNDS = {"dry bed": 0.048, "wet bed": 0.041, "dry rough bed": 0.046}


def averages(dam, time):
    """Cell means of the exact state: at an angle the dam cuts cells."""
    fine = square(CELLS * FINER, SIZE)
    return [q.reshape(CELLS, FINER, CELLS, FINER).mean(axis=(1, 3)) for q in dam.state(*fine.centres, time)]


def error(dam, run):
    """L1 of h where neither walls nor, on rough ground, the tip of the water count."""
    x, y = square(CELLS, SIZE).centres
    along = x * np.cos(dam.angle) + y * np.sin(dam.angle)
    last = 0.7 * dam.reach(TIME) if isinstance(dam, Dressler) else np.inf
    clear = (np.hypot(x, y) < CLEAR) & (along < last)
    h = run(averages(dam, 0.0), getattr(dam, "manning_n", 0.0))
    return l1(h[clear], averages(dam, TIME)[0][clear])


def ours(start, manning_n, **params):
    numbers = {"eddy_viscosity": 0.0} | params
    solver = make_solver(np.zeros((CELLS, CELLS)), SIZE / CELLS, manning_n, **numbers)
    solver.set_water(*(q.astype(np.float32) for q in start))
    solver.advance_to(TIME)
    return solver.depth()


def published(start, manning_n):
    return simulate(np.zeros((CELLS, CELLS)), SIZE / CELLS, *start, TIME, manning_n=manning_n)[0]


@pytest.fixture(scope="module")
def aligned():
    return {kind: error(made(0.0), ours) for kind, made in KINDS.items()}


@pytest.mark.parametrize("angle", ANGLES)
@pytest.mark.parametrize("kind", KINDS)
def test_dam_break_across_the_grid_is_as_good_as_along_it(kind, angle, aligned, figure):
    dam = KINDS[kind](ANGLES[angle])
    found, yardstick = error(dam, ours), error(dam, published)
    assert yardstick >= BOUNDS[kind]
    figure(DAMS, f"L1 of h, {kind}, {angle}", found, unit="m", below=BOUNDS[kind], yardstick=yardstick)
    figure(DAMS, f"the same against the aligned run, {kind}, {angle}", found / aligned[kind], below=1.25)


def test_eddy_viscosity_costs_less_than_the_published_scheme_loses(figure):
    def mixed(start, manning_n):
        return ours(start, manning_n, eddy_viscosity=SolverParams().eddy_viscosity)

    dam = KINDS["dry rough bed"](np.pi / 4.0)
    found, yardstick = error(dam, mixed), error(dam, published)
    name = "L1 of h, dry rough bed, 45 degrees, with eddy viscosity"
    figure(DAMS, name, found, unit="m", below=0.0525, yardstick=yardstick)


def test_first_order_run_fails_the_bounds():
    def first(start, manning_n):
        return ours(start, manning_n, order=1)

    assert all(error(made(np.pi / 6.0), first) > BOUNDS[kind] for kind, made in KINDS.items())


@pytest.mark.parametrize("angle", ANGLES)
def test_basin_does_not_feel_the_direction_of_the_grid(angle, figure):
    grid = square(80, 4000.0)

    def miss(phase):
        bowl = ThackerPlanar(a=1000.0, h0=10.0, sigma=500.0, phase=phase)
        time = 1.25 * bowl.period
        return l1(solve(bowl, grid, time)[0], bowl.state(*grid.centres, time)[0])

    figure(BASIN, f"L1 of h against the aligned run, {angle}", miss(ANGLES[angle]) / miss(0.0), below=1.1)


def test_wrong_angle_would_be_seen(aligned):
    grid = Grid(CELLS, CELLS, SIZE / CELLS, -0.5 * SIZE, -0.5 * SIZE)
    near, far = (Ritter(10.0, angle=angle).state(*grid.centres, TIME)[0] for angle in (0.5, 0.54))
    assert l1(near, far) > 2.0 * aligned["dry bed"]
