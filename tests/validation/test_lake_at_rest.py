"""Lake at rest among emergent hills (SWASHES section 3.1.2; Audusse et al. 2004): water that must not move
at all.

A solver whose bed slope and pressure do not cancel exactly makes currents out of nothing at every shore;
after 10 000 steps they would be seen. The bed is smooth (hills out of the water) or random and steep (up to
4 m from cell to cell).
"""

import numpy as np
import pytest

from solver_service.numerics import EdgeBoundary, FloodModel, ShallowWaterSolver, SolverParams
from tests.validation.runs import square

CASE = "Lake at rest, 64 x 64 cells, 10 000 steps"
GRID = square(64, 640.0)
LEVEL = 2.0
STEPS = 10_000


def smooth_hills():
    x, y = GRID.centres
    return 1.5 + 1.5 * np.sin(x / 50.0) * np.cos(y / 70.0)


def random_steep():
    return np.random.default_rng(1959).uniform(0.0, 4.0, (64, 64))


def lake_with_beach():
    """A shore all along an edge that is open: the water must neither leave nor feel the edge."""
    x, y = GRID.centres
    return 4.0 * np.maximum(np.abs(x), np.abs(y)) / 320.0 + 0.3 * np.sin(x / 20.0) * np.sin(y / 30.0)


def rest(bed, level=LEVEL, boundaries=(), **params):
    """Run ``STEPS`` steps and return the solver and the first depth."""
    bed = bed.astype(np.float32)
    roughness = np.random.default_rng(8).uniform(0.01, 0.1, bed.shape).astype(np.float32)
    model = FloodModel(dx=GRID.dx, z_b=bed, manning_n=roughness, boundaries=boundaries)
    solver = ShallowWaterSolver(model, SolverParams(**params), device="cpu")
    start = np.maximum(np.float32(level) - bed, np.float32(0.0))
    solver.set_water(start)
    step = float(solver.params.cfl * GRID.dx / np.sqrt(9.81 * start.max()))
    # Water that does not move may sleep until the next call: short calls keep every wet cell awake.
    for k in range(1, STEPS // 3 + 2):
        solver.advance_to(2.99 * k * step)
    assert solver.step_count >= STEPS
    return solver, start


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("bed", [smooth_hills, random_steep], ids=["smooth", "random steep"])
def test_lake_with_emergent_hills_stays_at_rest(bed, order, figure):
    z_b = bed()
    assert (z_b > LEVEL).mean() > 0.1
    solver, start = rest(z_b, order=order)
    u, v = solver.velocity()
    h = solver.depth().astype(np.float64)
    kind = f"{bed.__name__.replace('_', ' ')} bed, order {order}"
    fastest = np.hypot(u, v).max()
    figure(CASE, f"largest speed, {kind}", fastest, unit="m/s", below=1e-6, round_off=True)
    lost = abs(h.sum() / start.astype(np.float64).sum() - 1.0)
    figure(CASE, f"volume error, {kind}", lost, below=1e-7, round_off=True)
    wet = h > 0.0
    level = np.abs(h + z_b - LEVEL)[wet].max()
    figure(CASE, f"largest change of the level, {kind}", level, unit="m", below=1e-6, round_off=True)
    assert np.array_equal(wet, start > 0.0)


def test_lake_with_a_dry_beach_before_open_edges_stays_at_rest(figure):
    edges = tuple(
        EdgeBoundary(edge=e, kind="open", first=0, last=64) for e in ("west", "east", "south", "north")
    )
    bed = lake_with_beach()
    solver, start = rest(bed, level=2.5, boundaries=edges)
    assert max(edge.max() for edge in (start[0], start[-1], start[:, 0], start[:, -1])) == 0.0
    fastest = np.hypot(*solver.velocity()).max()
    figure(CASE, "largest speed, beach and open edges", fastest, unit="m/s", below=1e-6, round_off=True)
    assert solver.budget().outflow == 0.0


def test_lake_that_is_tilted_by_a_millimetre_moves():
    """The negative control: the test sees a lake that is not at rest."""
    x, _ = GRID.centres
    model = FloodModel(dx=GRID.dx, z_b=np.zeros(x.shape, np.float32), manning_n=0.03)
    solver = ShallowWaterSolver(model, SolverParams(), device="cpu")
    solver.set_water((2.0 + 0.001 * x / 640.0).astype(np.float32))
    solver.advance_to(30.0)
    assert np.hypot(*solver.velocity()).max() > 1e-4
