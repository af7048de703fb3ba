"""Lake at rest among emergent hills (SWASHES section 3.1.2; Audusse et al. 2004): water that must not move
at all.

A solver whose bed slope and pressure do not cancel exactly makes currents out of nothing at every shore;
after 10 000 steps they would be seen. Smooth hills stand out of the water; random beds step by up to 4 m
from cell to cell; a deep reservoir among cliffs has a level that float32 cannot hold. The water must stay
at rest bit for bit.
"""

import numpy as np
import pytest

from solver_service.numerics import EdgeBoundary, FloodModel, ShallowWaterSolver, SolverParams
from tests.validation.runs import square

CASE = "Lake at rest, 64 x 64 cells, 10 000 steps"
GRID = square(64, 640.0)
STEPS = 10_000


def smooth_hills():
    x, y = GRID.centres
    return 1.5 + 1.5 * np.sin(x / 50.0) * np.cos(y / 70.0)


def random_steep():
    return np.random.default_rng(1959).uniform(0.0, 4.0, (64, 64))


def deep_reservoir():
    x, y = GRID.centres
    cliffs = np.random.default_rng(1889).uniform(-12.0, 12.0, (64, 64))
    return 75.0 + 60.0 * np.sin(x / 90.0) * np.cos(y / 110.0) + cliffs


def lake_with_beach():
    """A shore all along an edge that is open: the water must neither leave nor feel the edge."""
    x, y = GRID.centres
    return 4.0 * np.maximum(np.abs(x), np.abs(y)) / 320.0 + 0.3 * np.sin(x / 20.0) * np.sin(y / 30.0)


def rest(bed, level, boundaries=(), **params):
    """Run ``STEPS`` steps and return the solver and the first depth."""
    bed = bed.astype(np.float32)
    roughness = np.random.default_rng(8).uniform(0.01, 0.1, bed.shape).astype(np.float32)
    model = FloodModel(dx=GRID.dx, z_b=bed, manning_n=roughness, boundaries=boundaries)
    solver = ShallowWaterSolver(model, SolverParams(**params), device="cpu")
    start = np.maximum(level - bed.astype(np.float64), 0.0).astype(np.float32)
    solver.set_water(start)
    step = float(solver.params.cfl * GRID.dx / np.sqrt(9.81 * start.max()))
    # Water that does not move may sleep until the next call: short calls keep every wet cell awake.
    for k in range(1, STEPS // 3 + 2):
        solver.advance_to(2.99 * k * step)
    assert solver.step_count >= STEPS
    return solver, start


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize(
    ("bed", "level"),
    [(smooth_hills, 2.0), (random_steep, 2.0), (deep_reservoir, 100.3)],
    ids=lambda value: "",
)
def test_lake_with_emergent_hills_stays_at_rest(bed, level, order, figure):
    z_b = bed()
    assert (z_b > level).mean() > 0.1
    solver, start = rest(z_b, level, order=order)
    kind = f"{bed.__name__.replace('_', ' ')}, order {order}"
    fastest = np.hypot(*solver.velocity()).max()
    figure(CASE, f"largest speed, {kind}", fastest, unit="m/s", below=0.0)
    changed = np.count_nonzero(solver.depth() != start)
    figure(CASE, f"cells whose depth has changed, {kind}", changed, below=0.0)
    assert solver.budget().error_relative == 0.0


def test_lake_with_a_dry_beach_before_open_edges_stays_at_rest(figure):
    edges = tuple(
        EdgeBoundary(edge=e, kind="open", first=0, last=64) for e in ("west", "east", "south", "north")
    )
    bed = lake_with_beach()
    solver, start = rest(bed, level=2.5, boundaries=edges)
    assert max(edge.max() for edge in (start[0], start[-1], start[:, 0], start[:, -1])) == 0.0
    fastest = np.hypot(*solver.velocity()).max()
    figure(CASE, "largest speed, beach and open edges", fastest, unit="m/s", below=0.0)
    assert solver.budget().outflow == 0.0


def test_lake_that_is_tilted_by_a_millimetre_moves():
    """The negative control: the test sees a lake that is not at rest."""
    x, _ = GRID.centres
    model = FloodModel(dx=GRID.dx, z_b=np.zeros(x.shape, np.float32), manning_n=0.03)
    solver = ShallowWaterSolver(model, SolverParams(), device="cpu")
    solver.set_water((2.0 + 0.001 * x / 640.0).astype(np.float32))
    solver.advance_to(30.0)
    assert np.hypot(*solver.velocity()).max() > 1e-4
