"""Volume over a long run with moving shores, a bed that is replaced under way, and a source of known
volume.

The budget that the solver keeps must close, and so must the sum of its depths, counted here without the
solver's help.
"""

import numpy as np

from solver_service.numerics import FloodModel, ShallowWaterSolver, SolverParams, Source
from tests.validation.runs import make_solver, square

LONG = "Conservation: sloshing over a bumpy bed, 64 x 64 cells"
INFLOW = "Conservation: a source with a triangular hydrograph"
GRID = square(64, 640.0)


def bumps():
    x, y = GRID.centres
    return 1.0 + np.sin(x / 31.0) * np.sin(y / 43.0) + 0.3 * np.sin(x / 9.0)


def stored(solver):
    return float(solver.depth().astype(np.float64).sum()) * GRID.dx**2


def sloshing():
    bed = bumps()
    x, _ = GRID.centres
    solver = make_solver(bed, GRID.dx, manning_n=0.02)
    solver.set_water(np.where(x < 0.0, np.maximum(3.0 - bed, 0.0), 0.0).astype(np.float32))
    return solver, bed


def test_long_run_with_wetting_and_drying_keeps_its_volume(figure):
    solver, _ = sloshing()
    before = stored(solver)
    wet = set()
    for time in (50.0, 200.0, 600.0, 1200.0, 2400.0):
        solver.advance_to(time)
        wet.add(int((solver.depth() > 0.001).sum()))
    assert solver.step_count > 2000
    assert len(wet) > 3
    figure(
        LONG,
        "volume error, counted from the depths",
        abs(stored(solver) / before - 1.0),
        below=2e-8,
        instead="round-off",
    )
    figure(
        LONG,
        "volume error of the solver's budget",
        abs(solver.budget().error_relative),
        below=2e-8,
        instead="round-off",
    )
    assert solver.depth().min() >= 0.0


def test_bed_replaced_under_water_books_exactly_what_it_cuts(figure):
    solver, bed = sloshing()
    solver.advance_to(100.0)
    before = stored(solver)
    raised = bed.copy()
    raised[20:24, 5:60] += 2.5
    raised[40:50, 30:34] -= 1.0
    cut = solver.replace_bed(raised.astype(np.float32)).volume_cut
    assert cut > 100.0
    figure(
        LONG,
        "water cut by an edit, booked against counted",
        abs((before - stored(solver)) / cut - 1.0),
        below=1e-5,
        instead="round-off",
    )
    solver.advance_to(500.0)
    kept = abs((stored(solver) + cut) / before - 1.0)
    figure(LONG, "volume error after an edit", kept, below=2e-8, instead="round-off")
    assert abs(solver.budget().error_relative) < 2e-8


def test_water_keeps_its_level_where_raised_ground_stays_wet():
    bed = np.zeros((32, 32))
    solver = make_solver(bed, 10.0)
    solver.set_water(np.full((32, 32), 3.0, np.float32))
    bed[10:20, 10:20] = 1.0
    solver.replace_bed(bed.astype(np.float32))
    np.testing.assert_allclose(solver.depth() + bed, 3.0, atol=1e-6)


def test_source_delivers_the_volume_of_its_hydrograph(figure):
    bed = bumps()
    rows, cols = (a.astype(np.int32) for a in np.divmod(np.array([2080, 2081, 2144, 2145]), 64))
    times, discharge = np.array([10.0, 60.0, 210.0, 300.0]), np.array([0.0, 50.0, 20.0, 0.0])
    source = Source(rows=rows, cols=cols, times=times, discharge=discharge)
    model = FloodModel(dx=GRID.dx, z_b=bed.astype(np.float32), manning_n=0.03, sources=(source,))
    solver = ShallowWaterSolver(model, SolverParams(), device="cpu")
    solver.set_water(np.zeros((64, 64), np.float32))
    for until in (35.0, 137.0, 400.0):
        solver.advance_to(until)
        span = np.union1d(times, [until])
        span = span[span <= until]
        exact = np.trapezoid(np.interp(span, times, discharge), span)
        # The solver hands water out in quanta of 2^-16 m: less than one is kept back.
        kept_back = exact - stored(solver)
        quantum = rows.size * GRID.dx**2 * 2.0**-16
        assert -2e-8 * exact < kept_back < quantum + 2e-8 * exact
        off = abs(solver.budget().error_relative)
        figure(INFLOW, f"volume error at {until:.0f} s", off, below=2e-8, instead="round-off")
    figure(INFLOW, "volume short of the hydrograph's", kept_back / exact, below=2e-8, instead="round-off")
