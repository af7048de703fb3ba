"""Sources and rain bring what their series say, to the last quantum."""

import numpy as np
import pytest

from solver_service.numerics import FloodModel, ModelError, Rain, Source
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
    s = solver(basin(rain=Rain.uniform(0.0, 10e-3 / 3600.0, (30, 30))), threads=1)
    s.set_water(np.full((30, 30), 12.0, np.float32))
    s.advance_to(600.0)
    fallen = 10e-3 / 3600.0 * 600.0
    assert s.depth().mean(dtype=np.float64) - 12.0 == pytest.approx(fallen, abs=QUANTUM)
    assert s.budget().rain == pytest.approx(fallen * 900 * CELL, abs=900 * CELL * QUANTUM)
    assert s.budget().error_relative == 0.0


def test_rain_does_not_fall_on_blocked_cells():
    blocked = np.zeros((30, 30), bool)
    blocked[5:9, 5:9] = True
    s = solver(basin(rain=Rain.uniform(0.0, 1e-3, (30, 30)), blocked=blocked), threads=1)
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


def test_raster_rain_falls_where_it_is_said_to_and_closes_the_budget():
    rates = np.zeros((3, 2, 2))
    rates[:, 0, 1], rates[:, 1, 0] = [1e-4, 3e-4, 0.0], 2e-4
    rows, cols = np.repeat([0, 1], [10, 20]), np.repeat([0, 1], [25, 5])
    linear, stepped = (
        solver(basin(rain=Rain([0.0, 20.0, 40.0], rates, rows, cols, interpolation)), threads=1)
        for interpolation in ("linear", "step")
    )
    for s, east in ((linear, 7e-3), (stepped, 8e-3)):
        s.advance_to(40.0)
        fallen = east * 50 * CELL + 8e-3 * 500 * CELL
        assert s.budget().rain == pytest.approx(fallen, abs=550 * CELL * QUANTUM)
        assert abs(s.budget().error_relative) < 1e-7
        assert s.depth()[2, 2] == 0.0
        assert s.depth()[25, 3] == pytest.approx(8e-3, abs=2 * QUANTUM)
        assert s.depth()[2, 29] == pytest.approx(east, abs=1e-4)


def test_sources_are_booked_by_name():
    sources = (
        Source([3], [3], [0.0], [2.0]),
        Source([9], [9], [0.0], [1.0], id="spring"),
        Source([20], [20], [0.0], [0.5]),
    )
    s = solver(basin(sources=sources), threads=1)
    s.advance_to(10.0)
    booked = s.budget().sources
    assert list(booked) == ["source-1", "spring", "source-3"]
    assert list(booked.values()) == pytest.approx([20.0, 10.0, 5.0], abs=1e-3)


@pytest.mark.parametrize("interpolation", ["linear", "step"])
def test_what_was_due_before_time_zero_is_not_brought(interpolation):
    source = Source([10], [10], [-100.0, 100.0], [0.0, 2.0])
    rain = Rain.uniform([-50.0, 50.0], [1e-4, 1e-4], (30, 30), interpolation)
    s = solver(basin(sources=(source,), rain=rain), threads=1)
    s.advance_to(10.0)
    assert s.budget().inflow == pytest.approx(10.5, abs=3 * CELL * QUANTUM)
    assert s.budget().rain == pytest.approx(1e-3 * 900 * CELL, rel=2e-2)
