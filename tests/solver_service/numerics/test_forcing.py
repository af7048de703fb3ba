"""Sources and rain bring what their series say, to the last quantum."""

import numpy as np
import pytest

from solver_service.numerics import FloodModel, ModelError, Source
from tests.solver_service.numerics.floods import solver

CELL = 4.0
QUANTUM = 2.0**-16


def basin(**kw):
    return FloodModel(2.0, np.zeros((30, 30), np.float32), 0.03, **kw)


def test_a_hydrograph_brings_the_integral_of_its_series():
    source = Source([10, 10, 11], [10, 11, 10], [1.0, 3.0, 7.0], [0.0, 4.0, 2.0])
    s = solver(basin(sources=(source,)), threads=1)
    for time, volume in ((1.0, 0.0), (3.0, 4.0), (7.0, 16.0), (10.0, 22.0)):
        s.advance_to(time)
        assert s.budget().inflow == pytest.approx(volume, abs=3 * CELL * QUANTUM)
        assert s.budget().stored == pytest.approx(s.budget().inflow, rel=1e-6, abs=1e-6)


def test_rain_on_a_deep_lake_is_not_lost_to_rounding():
    s = solver(basin(rain=(np.array([0.0]), np.array([10e-3 / 3600.0]))), threads=1)
    s.set_water(np.full((30, 30), 12.0, np.float32))
    s.advance_to(600.0)
    fallen = 10e-3 / 3600.0 * 600.0
    assert s.depth().mean(dtype=np.float64) - 12.0 == pytest.approx(fallen, abs=QUANTUM)
    assert s.budget().rain == pytest.approx(fallen * 900 * CELL, abs=900 * CELL * QUANTUM)
    assert s.budget().error_relative == 0.0


def test_rain_does_not_fall_on_blocked_cells():
    blocked = np.zeros((30, 30), bool)
    blocked[5:9, 5:9] = True
    s = solver(basin(rain=(np.array([0.0]), np.array([1e-3])), blocked=blocked), threads=1)
    s.advance_to(10.0)
    assert not s.depth()[blocked].any()
    assert s.budget().rain == pytest.approx(1e-2 * (900 - 16) * CELL, rel=2e-3)


def test_two_sources_may_share_a_cell():
    source = Source([10], [10], [0.0], [1.0])
    s = solver(basin(sources=(source, source)), threads=1)
    s.advance_to(5.0)
    assert s.budget().inflow == pytest.approx(10.0, abs=0.01)


def test_a_source_off_the_grid_is_refused():
    with pytest.raises(ModelError, match=r"row 30, column 2.*off the 30 x 30 grid"):
        basin(sources=(Source([30], [2], [0.0], [1.0]),))


@pytest.mark.parametrize(
    ("times", "rates", "words"),
    [
        ([0.0, 0.0], [1.0, 1.0], "not after"),
        ([0.0], [-1.0], "finite value >= 0"),
        ([0.0, 1.0], [1.0], "as many"),
    ],
)
def test_a_series_that_is_not_valid_is_refused(times, rates, words):
    with pytest.raises(ModelError, match=words):
        Source([1], [1], times, rates)
