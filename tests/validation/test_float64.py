"""What float32 costs: the solver against the same mathematics in float64.

Both take the same bed and water (rounded to float32) and the same steps, so that what differs is arithmetic.
The figures stand beside the error of the scheme on the same grid, where an exact solution tells it.
"""

import numpy as np
import pytest

from solver_service.numerics import FloodModel, ShallowWaterSolver, SolverParams
from tests.validation.float64_run import simulate
from tests.validation.runs import Grid, channel, l1, square
from tests.validation.solutions import Ritter, ThackerPlanar
from tests.validation.test_malpasset import MANNING_N, folder

CASE = "float32 against float64"


class Pair:
    """One case run in both precisions."""

    def __init__(self, model: FloodModel, start, until: float, control: SolverParams | None = None):
        self.start = start
        solver = ShallowWaterSolver(model, SolverParams(), device="cpu")
        solver.set_water(*start)
        solver.advance_to(until)
        u, v = solver.velocity()
        self.single = tuple(q.astype(np.float64) for q in (solver.depth(), u, v))
        self.double, self.steps = simulate(model, control or SolverParams(), *start, until)
        self.same_steps = self.steps == solver.step_count

    @property
    def depth(self):
        """Mean and largest difference of the depth [m]."""
        off = np.abs(self.single[0] - self.double[0])
        return float(off.mean()), float(off.max())

    @property
    def discharge(self):
        """Mean difference of the unit discharge [m2/s]."""
        (h, u, v), (h_d, u_d, v_d) = self.single, self.double
        return float(np.hypot(h * u - h_d * u_d, h * v - h_d * v_d).mean())


def exact_case(solution, grid: Grid, until: float, **options) -> Pair:
    x, y = grid.centres
    model = FloodModel(dx=grid.dx, z_b=solution.bed(x, y).astype(np.float32), manning_n=0.0)
    return Pair(model, solution.state(x, y, 0.0), until, **options)


BASIN = ThackerPlanar(1000.0, 10.0, 500.0)


def column_on_bumps() -> Pair:
    """A column of water falls on a rough bumpy dry bed and reaches the walls."""
    x, y = square(96, 1920.0).centres
    bed = 0.5 + 0.4 * np.sin(x / 60.0) * np.cos(y / 45.0)
    h = np.where(np.hypot(x, y) < 500.0, 10.0 - bed, 0.0)
    still = np.zeros_like(h)
    return Pair(FloodModel(dx=20.0, z_b=bed.astype(np.float32), manning_n=0.03), (h, still, still), 120.0)


@pytest.mark.parametrize(
    ("name", "run", "mean", "largest", "moved"),
    [
        (
            "Thacker's plane, one revolution",
            lambda: exact_case(BASIN, square(80, 4000.0), BASIN.period),
            2e-6,
            1e-4,
            1e-5,
        ),
        (
            "dam break on a dry bed, 40 s",
            lambda: exact_case(Ritter(10.0), channel(200, -1000.0, 1000.0), 40.0),
            2e-6,
            1e-4,
            1e-5,
        ),
        ("column on rough bumps, 120 s", column_on_bumps, 2e-6, 1e-4, 1e-5),
    ],
)
def test_float32_differs_from_float64_by_rounding(name, run, mean, largest, moved, figure):
    pair = run()
    assert pair.same_steps
    figure(CASE, f"mean difference of h, {name}", pair.depth[0], unit="m", below=mean)
    figure(CASE, f"largest difference of h, {name}", pair.depth[1], unit="m", below=largest)
    figure(CASE, f"mean difference of the unit discharge, {name}", pair.discharge, unit="m2/s", below=moved)


def test_rounding_is_small_beside_the_error_of_the_scheme(figure):
    grid = square(80, 4000.0)
    pair = exact_case(BASIN, grid, BASIN.period)
    error = l1(pair.double[0], BASIN.state(*grid.centres, BASIN.period)[0])
    figure(
        CASE, "rounding in units of the scheme's error, Thacker's plane", pair.depth[0] / error, below=1e-3
    )


def test_float64_reference_keeps_volume_and_a_lake_at_rest():
    x, y = square(40, 400.0).centres
    bed = 3.0 * np.sin(x / 30.0) * np.cos(y / 20.0)
    model = FloodModel(dx=10.0, z_b=bed.astype(np.float32), manning_n=0.02)
    still = np.zeros_like(bed)
    lake = np.maximum(1.0 - model.z_b, np.float32(0.0))
    (h, u, v), _ = simulate(model, SolverParams(), lake, still, still, 60.0)
    # The float32 lake is level to its rounding only, which float64 sees.
    assert np.abs(h - lake).max() < 1e-6
    assert max(np.abs(u).max(), np.abs(v).max()) < 1e-5
    pair = column_on_bumps()
    assert abs(pair.double[0].sum() / pair.start[0].astype(np.float32).astype(np.float64).sum() - 1.0) < 1e-12


def test_another_scheme_leaves_the_bounds():
    pair = exact_case(
        Ritter(10.0), channel(200, -1000.0, 1000.0), 40.0, control=SolverParams(limiter_theta=1.45)
    )
    assert pair.depth[0] > 1e-4


@pytest.mark.slow
@pytest.mark.timeout(600)
@pytest.mark.parametrize(("until", "mean_bound", "largest_bound"), [(150.0, 5e-5, 5e-3), (300.0, 5e-4, 0.3)])
def test_malpasset_in_float32_differs_from_float64_by_rounding(until, mean_bound, largest_bound, figure):
    data = np.load(folder() / "malpasset_15m.npz")

    def coarse(name):
        field = data[name][::-1][:612, :1148]
        return field.reshape(153, 4, 287, 4).mean(axis=(1, 3))

    bed, h = coarse("bed"), coarse("depth0")
    still = np.zeros_like(h)
    model = FloodModel(dx=60.0, z_b=bed.astype(np.float32), manning_n=MANNING_N)
    pair = Pair(model, (h, still, still), until)
    assert pair.same_steps
    wet = h.astype(bool) | (pair.double[0] > 1e-3)
    where = f"Malpasset on 60 m, {until:.0f} s"
    mean = pair.depth[0] / wet.mean()
    figure(CASE, f"mean difference of h in wet cells, {where}", mean, unit="m", below=mean_bound)
    figure(CASE, f"largest difference of h, {where}", pair.depth[1], unit="m", below=largest_bound)
