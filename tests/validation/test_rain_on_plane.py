"""Rain on a plane that begins dry, without and with infiltration: rise, equilibrium and recession.

Source: Henderson and Wooding (1964), Woolhiser and Liggett (1967), Giraldez and Woolhiser (1996); see
``solutions/rain_on_plane.py``. 100 mm/h fall for 20 minutes on 200 m at a slope of 5 %; water of less than
2 cm runs off over cells of 2 m and leaves through an edge with normal depth. The kinematic wave itself is off
by 1 / K, a thousandth.
"""

from dataclasses import replace

import numpy as np
import pytest

from solver_service.numerics import (
    EdgeBoundary,
    FloodModel,
    Infiltration,
    Rain,
    ShallowWaterSolver,
    SolverParams,
)
from tests.validation.pictures import Line, Panel
from tests.validation.runs import channel, l1
from tests.validation.solutions import RainOnPlane

CASE = "Rain on a plane, 100 cells of 2 m"
ROWS, CELLS = 2, 100
DRY = RainOnPlane(length=200.0, slope=0.05, manning_n=0.05, rain=100.0 / 3.6e6, rain_end=1200.0)
PLANES = {"rain": DRY, "rain and infiltration": replace(DRY, infiltration=30.0 / 3.6e6)}
GRID = channel(CELLS, 0.0, DRY.length, ROWS)
TIMES = np.arange(0.0, 2401.0, 60.0)
PHASES = {"rise": 300.0, "equilibrium": 1200.0, "recession": 1500.0}
LIMITS = {"rise": 0.0035, "equilibrium": 0.0022, "recession": 0.0042}


def run(plane, **params):
    """Depths at the times of PHASES and the mean discharge of each minute through the eastern edge [m2/s]."""
    x, y = GRID.centres
    soil = Infiltration("constant", None, {"rate": np.array([plane.infiltration])})
    model = FloodModel(
        dx=GRID.dx,
        z_b=plane.bed(x, y),
        manning_n=plane.manning_n,
        rain=Rain.uniform([0.0, plane.rain_end], [plane.rain, 0.0], x.shape, "step"),
        infiltration=soil if plane.infiltration else None,
        boundaries=(EdgeBoundary("east", "normal_depth", 0, ROWS, slope=plane.slope),),
    )
    solver = ShallowWaterSolver(model, SolverParams(**params), device="cpu")
    solver.set_water(np.zeros(x.shape, np.float32))
    depths, left = {}, [0.0]
    for time in TIMES[1:]:
        solver.advance_to(time)
        depths[time] = solver.depth()[0].astype(np.float64)
        left.append(solver.budget().outflow)
    assert abs(solver.budget().error_relative) < 1e-6
    return depths, np.diff(left) / (60.0 * ROWS * GRID.dx)


def hydrograph(plane):
    """The exact mean discharge of each minute [m2/s]."""
    return np.array([plane.outflow(np.linspace(t, t + 60.0, 13)).mean() for t in TIMES[:-1]])


@pytest.fixture(scope="module")
def computed():
    return {name: run(plane) for name, plane in PLANES.items()}


@pytest.mark.parametrize("phase", PHASES)
@pytest.mark.parametrize("name", PLANES)
def test_depth_follows_the_kinematic_wave(name, phase, computed, figure):
    time = PHASES[phase]
    exact = PLANES[name].state(GRID.centres[0][0], 0.0 * GRID.centres[0][0], time)[0]
    off = l1(computed[name][0][time], exact) / exact.mean()
    figure(CASE, f"L1 of h relative to the mean depth, {phase}, {name}", off, below=LIMITS[phase])


@pytest.mark.parametrize("name", PLANES)
def test_hydrograph_rises_stands_and_falls_as_it_should(name, computed, figure, picture):
    exact, found = hydrograph(PLANES[name]), computed[name][1]
    peak = PLANES[name].excess * PLANES[name].length
    figure(
        CASE,
        f"largest error of the discharge, of its peak, {name}",
        np.abs(found - exact).max() / peak,
        below=0.011,
    )
    figure(CASE, f"mean error of the discharge, of its peak, {name}", l1(found, exact) / peak, below=0.0012)
    standing = (TIMES[:-1] > PLANES[name].concentration_time + 60.0) & (TIMES[1:] <= PLANES[name].rain_end)
    figure(
        CASE,
        f"error of the equilibrium discharge, {name}",
        np.abs(found[standing] / peak - 1.0).max(),
        below=2e-4,
    )
    x, minutes, lines = GRID.centres[0][0], TIMES[1:] / 60.0 - 0.5, []
    for time in PHASES.values():
        lines.append(Line("exact", x, 1e3 * PLANES[name].state(x, x, time)[0], "kinematic wave"))
        lines.append(Line("computed", x[::3], 1e3 * computed[name][0][time][::3]))
    flow = Line("exact", minutes, 1e3 * exact, "kinematic wave"), Line("computed", minutes, 1e3 * found)
    picture(
        CASE,
        name.replace(" ", "_"),
        Panel(
            f"{name}: depth after {', '.join(f'{t / 60:.0f}' for t in PHASES.values())} min",
            "x [m]",
            "h [mm]",
            tuple(lines),
        ),
        Panel(f"{name}: discharge", "time [min]", "q [l/s per m]", flow),
    )


def test_other_roughness_or_infiltration_fails_the_bounds(computed):
    found = computed["rain and infiltration"]
    for wrong in (
        replace(PLANES["rain and infiltration"], manning_n=0.055),
        replace(PLANES["rain and infiltration"], infiltration=27.0 / 3.6e6),
    ):
        exact = hydrograph(wrong)
        assert np.abs(found[1] - exact).max() > 0.03 * wrong.excess * wrong.length
