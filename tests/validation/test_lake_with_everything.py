"""A lake at rest where everything that could move it is at hand: edges, sources, infiltration, structures.

Each is asked for nothing: the stage stands at the level, the discharge is none, the ground takes nothing,
pumps have not started, culverts and weirs have the same water on both sides, a levee will breach later. Not
one depth may change.
"""

import numpy as np
import pytest

from solver_service.numerics import (
    Breach,
    Culvert,
    EdgeBoundary,
    FloodModel,
    Infiltration,
    Pump,
    Rain,
    ShallowWaterSolver,
    SolverParams,
    Source,
    Weir,
)
from tests.validation.runs import square

CASE = "Lake at rest with edges and structures, 64 x 64 cells, 3000 steps"
GRID = square(64, 640.0)
N, LEVEL, STEPS = 64, 2.5, 3000
SIDES = ("west", "east", "south", "north")


def hills(rough):
    """Emergent hills in a lake that reaches every edge; ``rough`` adds steps of up to 2 m between cells."""
    x, y = GRID.centres
    bed = 1.5 + 1.5 * np.sin(x / 50.0) * np.cos(y / 70.0)
    steps = np.random.default_rng(4).uniform(-1.0, 1.0, bed.shape)
    return (bed + rough * steps).astype(np.float32)


def rest(bed, boundaries=(), level=LEVEL, **features):
    """Solver and first depth after STEPS steps."""
    model = FloodModel(dx=GRID.dx, z_b=bed, manning_n=0.03, boundaries=boundaries, **features)
    solver = ShallowWaterSolver(model, SolverParams(), device="cpu")
    start = np.maximum(level - bed.astype(np.float64), 0.0).astype(np.float32)
    solver.set_water(start)
    step = float(solver.params.cfl * GRID.dx / np.sqrt(9.81 * start.max()))
    # Water that does not move may sleep until the next call: short calls keep every wet cell awake.
    for k in range(1, STEPS // 3 + 2):
        solver.advance_to(2.99 * k * step)
    assert solver.step_count >= STEPS
    return solver, start


def everything():
    """Features that ask for nothing."""
    cell = np.array([30], np.int32)
    still = np.array([0.0])
    return {
        "sources": (Source(cell, cell, still, still),),
        "rain": Rain.uniform([0.0], [0.0], (N, N)),
        "infiltration": Infiltration("constant", None, {"rate": np.array([0.0])}),
        "structures": (
            Weir("weir", ((10.0, 20.0), (30.0, 20.0)), crest=2.2),
            Culvert("culvert", ((40, 10),), ((50, 12),), 1.0, 0.9, 1.0, 1.0, 100.0),
            Pump("pump", ((12, 40),), None, (0.0, 5.0), (2.0, 2.0), start_level=3.0, stop_level=2.8),
        ),
        "breaches": (
            Breach("breach", ((45.0, 30.0), (45.0, 45.0)), 3.5, 1.0, 600.0, 20.0, 60.0, start_time=1e6),
        ),
    }


def stages(level=LEVEL):
    return tuple(EdgeBoundary(e, "stage", 0, N, times=[0.0], values=[level]) for e in SIDES)


@pytest.mark.parametrize("rough", [0.0, 1.0], ids=["smooth", "steep"])
def test_lake_between_stage_edges_at_its_level_stays_at_rest(rough, figure):
    solver, start = rest(hills(rough), stages())
    kind = f"stage on all sides, {'steep' if rough else 'smooth'} bed"
    changed = np.count_nonzero(solver.depth() != start)
    figure(CASE, f"cells whose depth has changed, {kind}", changed, below=0.0)
    figure(CASE, f"largest speed, {kind}", np.hypot(*solver.velocity()).max(), unit="m/s", below=0.0)
    assert all(flow == (0.0, 0.0) for flow in solver.budget().edges.values())


@pytest.mark.parametrize("rough", [0.0, 1.0], ids=["smooth", "steep"])
def test_lake_with_every_feature_stays_at_rest(rough, figure):
    mixed = (
        stages()[0],
        EdgeBoundary("east", "discharge", 0, N, times=[0.0], values=[0.0]),
        EdgeBoundary("south", "open", 0, N),
    )
    solver, start = rest(hills(rough), mixed, **everything())
    kind = f"all features, {'steep' if rough else 'smooth'} bed"
    dry = start <= 0.0
    changed = np.count_nonzero((solver.depth() != start)[~dry])
    figure(CASE, f"cells whose depth has changed, {kind}", changed, below=0.0)
    figure(CASE, f"largest speed, {kind}", np.hypot(*solver.velocity()).max(), unit="m/s", below=0.0)
    assert solver.budget().error_relative == 0.0


def test_stage_a_millimetre_higher_moves_the_lake():
    """The negative control."""
    solver, start = rest(hills(0.0), stages(LEVEL + 0.001))
    assert np.hypot(*solver.velocity()).max() > 1e-5
    assert solver.depth().sum() > start.sum()
