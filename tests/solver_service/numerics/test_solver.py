"""Time, snapshots and refusals of the solver."""

import math

import numpy as np
import pytest

from solver_service.numerics import FloodModel, ModelError, Snapshot, SolverBlowUp
from tests.solver_service.numerics.floods import GAUGES, bed, differences, full_model, solver, wild_water


def begun(model=None, **params):
    model = model or full_model()
    s = solver(model, **{"threads": 1, "gauges": GAUGES, "gauge_interval": 0.35, **params})
    s.set_water(*wild_water(model.z_b))
    return s


def test_time_lands_exactly_on_what_was_asked():
    s = begun()
    for time in (0.1, 1.0 / 3.0, 2.0, 2.0):
        assert s.advance_to(time)
        assert s.time == time


def test_no_sliver_of_a_step_follows_before_a_landing():
    s = begun()
    s.advance_to(4.0)
    stable = s.dt
    before = s.step_count
    s.advance_to(4.0 + 1.01 * stable)
    assert s.step_count - before == 2
    assert s._engine.dt > 0.4 * stable


@pytest.mark.parametrize("engine", ["rows", "kernels"])
def test_a_run_split_by_a_snapshot_equals_the_whole_run_bit_for_bit(engine):
    whole = begun(engine=engine)
    parts = begun(engine=engine)
    for time in (2.0, 4.0):
        whole.advance_to(time)
        parts.advance_to(time)
    snapshot = parts.snapshot()
    parts.advance_to(5.0)
    second = begun(engine=engine)
    second.advance_to(1.0)
    second.restore(snapshot)
    for time in (6.0, 9.0):
        whole.advance_to(time)
        second.advance_to(time)
    assert differences(whole, second) == []


def test_a_snapshot_moves_between_engines():
    rows, kernels = begun(engine="rows"), begun(engine="kernels")
    rows.advance_to(3.0)
    kernels.restore(rows.snapshot())
    for s in (rows, kernels):
        s.advance_to(6.0)
    assert differences(rows, kernels) == []


def test_a_pause_changes_nothing():
    whole, paused = begun(), begun()
    whole.advance_to(6.0)
    answers = iter([False, False, True])
    assert not paused.advance_to(6.0, lambda: next(answers))
    assert 0.0 < paused.time < 6.0
    assert paused.advance_to(6.0, lambda: False)
    assert differences(whole, paused) == []


def test_a_snapshot_shares_no_memory_with_the_solver():
    s = begun()
    s.advance_to(1.0)
    snapshot = s.snapshot()
    kept = {name: array.copy() for name, array in snapshot.arrays.items()}
    s.advance_to(2.0)
    assert all(np.array_equal(kept[name], snapshot.arrays[name], equal_nan=True) for name in kept)


def test_a_snapshot_of_another_grid_is_refused():
    s = begun()
    other = solver(FloodModel(5.0, bed((30, 30)), 0.03), threads=1)
    with pytest.raises(ModelError, match="shape"):
        s.restore(other.snapshot())


def test_a_snapshot_that_lacks_a_part_is_refused():
    s = begun()
    snapshot = s.snapshot()
    arrays = {name: array for name, array in snapshot.arrays.items() if name != "edge_flow"}
    with pytest.raises(ModelError, match="edge_flow"):
        s.restore(Snapshot(arrays, snapshot.scalars))


@pytest.mark.parametrize("time", [-1.0, math.nan, math.inf])
def test_a_time_that_cannot_be_reached_is_refused(time):
    with pytest.raises(ModelError, match="time to compute to"):
        begun().advance_to(time)


def test_negative_depth_is_refused_with_its_cell():
    s = begun()
    h = np.ones(s.model.shape, np.float32)
    h[3, 4] = -0.5
    with pytest.raises(ModelError, match=r"-0.5 m in cell \(row 3, column 4\)"):
        s.set_water(h)


def test_water_that_is_not_finite_is_refused_with_its_cell():
    s = begun()
    u = np.zeros(s.model.shape, np.float32)
    u[1, 2] = np.nan
    with pytest.raises(ModelError, match=r"velocity u is nan in cell \(row 1, column 2\)"):
        s.set_water(np.ones_like(u), u)


@pytest.mark.parametrize("engine", ["rows", "kernels"])
def test_a_value_that_is_not_finite_stops_the_run_with_its_cell(engine):
    s = begun(engine=engine)
    s.advance_to(1.0)
    s._store.arrays["u0"].numpy()[2 + 40, 2 + 50] = np.nan
    s._store.arrays["u1"].numpy()[2 + 40, 2 + 50] = np.nan
    s._store.arrays["h0"].numpy()[2 + 40, 2 + 50] = 1.0
    s._store.arrays["h1"].numpy()[2 + 40, 2 + 50] = 1.0
    with pytest.raises(SolverBlowUp) as caught:
        s.advance_to(9.0)
    assert abs(caught.value.row - 40) <= 12
    assert abs(caught.value.col - 50) <= 12
    assert "nan" in caught.value.value


@pytest.mark.parametrize("engine", ["rows", "kernels"])
def test_a_collapsed_time_step_stops_the_run_with_its_cell(engine):
    s = begun(engine=engine, dt_min=0.05)
    h = np.full(s.model.shape, 1.0, np.float32)
    u = np.zeros_like(h)
    u[33, 44] = 500.0
    s.set_water(h, u)
    with pytest.raises(SolverBlowUp) as caught:
        s.advance_to(1.0)
    assert (caught.value.row, caught.value.col, caught.value.time) == (33, 44, 0.0)


def test_depth_never_becomes_negative_and_volume_is_kept():
    model = FloodModel(5.0, bed(roughness=3.0), 0.0)
    s = solver(model, threads=1)
    s.set_water(*wild_water(model.z_b))
    for time in np.arange(1.0, 15.0):
        s.advance_to(float(time))
        assert s.depth().min() >= 0.0
    assert abs(s.budget().error_relative) < 1e-7


def test_maxima_take_in_every_step_and_not_output_times_only():
    model = FloodModel(5.0, np.zeros((20, 60), np.float32), 0.0)
    h = np.where(np.arange(60) < 20, np.float32(2.0), np.float32(0.0)) * np.ones((20, 1), np.float32)
    s = solver(model, threads=1)
    s.set_water(h)
    s.advance_to(100.0)
    m = s.maxima()
    assert (m.h >= s.depth()).all()
    assert (m.h[:, 59] > s.depth()[:, 59] + 0.1).all()
    arrival = m.arrival_time[10]
    assert (arrival[:20] == 0.0).all()
    assert (np.diff(arrival[20:50]) > 0.0).all()
    assert (m.time_of_max[10, 25:55] > arrival[25:55]).all()
    assert m.hazard.max() <= (m.h * (m.speed + 0.5) + 1.0).max()


def test_the_limiting_cell_is_the_fastest():
    s = begun()
    h = np.full(s.model.shape, 0.5, np.float32)
    u = np.zeros_like(h)
    u[12, 60] = 9.0
    s.set_water(h, u)
    assert s.limiting_cell() == (12, 60)


def test_blocked_cells_stay_dry_and_keep_the_water_out():
    z = np.zeros((20, 40), np.float32)
    blocked = np.zeros(z.shape, bool)
    blocked[:, 20] = True
    s = solver(FloodModel(5.0, z, 0.02, blocked=blocked), threads=1)
    s.set_water(np.where(np.arange(40) < 20, np.float32(3.0), np.float32(0.0)) * np.ones((20, 1), np.float32))
    s.advance_to(30.0)
    assert (s.depth()[:, :20] == 3.0).all()
    assert not s.depth()[:, 20:].any()


def film_above_a_lake(lake):
    rng = np.random.default_rng(5)
    z = np.zeros((40, 40), np.float32)
    z[:, 20:] = lake + 0.5 + 3.0 * rng.random((40, 20))
    h = np.where(z > 0.0, 10.0 ** rng.uniform(-5.0, -2.5, z.shape), lake).astype(np.float32)
    s = solver(FloodModel(5.0, z, 0.02), threads=1)
    s.set_water(h)
    return s


def test_films_that_drain_into_a_lake_never_become_negative_and_nothing_is_lost():
    s = film_above_a_lake(2.0)
    before = s.depth()
    for time in np.arange(0.5, 20.0, 0.5):
        s.advance_to(float(time))
        assert s.depth().min() >= 0.0
    lost = (before - s.depth())[:, 20:].sum(dtype=np.float64)
    assert lost > 0.01 * before[:, 20:].sum(dtype=np.float64)
    assert abs(s.budget().error_relative) < 1e-9
    gained = (s.depth() - before)[:, :20].sum(dtype=np.float64)
    assert gained == pytest.approx(lost, rel=1e-4)


def test_a_film_above_a_very_deep_lake_waits_until_the_lake_can_count_it():
    s = film_above_a_lake(199.5)
    before = s.depth()
    s.advance_to(5.0)
    assert s.depth().min() >= 0.0
    assert abs(s.budget().error_relative) < 1e-12
    assert s.depth()[:, 21:].sum(dtype=np.float64) == pytest.approx(
        before[:, 21:].sum(dtype=np.float64), rel=1e-2
    )
