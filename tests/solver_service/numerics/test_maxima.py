"""The largest values, arrivals and wet times are those of every step, not of output times."""

import numpy as np
import pytest

from solver_service.numerics import FloodModel, ModelError, SolverParams
from tests.solver_service.numerics.floods import differences, solver

SHAPE = (20, 60)
CLASSES = (0.15, 0.3, 1.0)


def dam_break(slope=0.01, **params):
    """Two metres of water behind a dam that goes, on a bed that rises by `slope` a cell to a dry end."""
    x = np.arange(SHAPE[1], dtype=np.float32)
    s = solver(FloodModel(5.0, np.tile(slope * x, (SHAPE[0], 1)), 0.01), **{"threads": 1, **params})
    s.set_water(np.where(x < 20, np.float32(2.0), np.float32(0.0)) * np.ones((SHAPE[0], 1), np.float32))
    return s


def by_step(s, until):
    """Depths, speeds and times after every step, the start included."""
    states, times = [s.depth()], [0.0]
    speeds = [np.hypot(*s.velocity())]
    while s.time < until:
        s.advance_to(min(s.time + 1e-3, until))  # shorter than any step that stability asks for
        states.append(s.depth())
        speeds.append(np.hypot(*s.velocity()))
        times.append(s.time)
    return np.array(states), np.array(speeds), np.array(times)


def test_what_is_kept_is_what_a_look_after_every_step_finds():
    s = dam_break(arrival_depths=CLASSES)
    h, speed, times = by_step(s, 1.5)
    m = s.maxima()
    np.testing.assert_array_equal(m.h, h.max(axis=0))
    counted = np.where(h > 0.05, speed, 0.0)
    np.testing.assert_allclose(m.speed, counted.max(axis=0), rtol=1e-6)
    np.testing.assert_allclose(m.unit_discharge, (h * counted).max(axis=0), rtol=1e-6)
    hazard = np.where(h > 0.01, h * (counted + 0.5) + np.where(h > 0.25, 1.0, 0.5), 0.0)
    np.testing.assert_allclose(m.hazard, hazard.max(axis=0), rtol=1e-6)
    wet = h > 0.01
    for depth, arrival in {0.01: m.arrival_time, **m.arrival_by_class}.items():
        first = np.where((h > depth).any(axis=0), times[(h > depth).argmax(axis=0)], np.nan)
        np.testing.assert_allclose(arrival, first, rtol=1e-6)
    rise = np.where(wet[1:], np.diff(h, axis=0) / np.diff(times)[:, None, None], 0.0)
    np.testing.assert_allclose(m.rise_rate_max, np.maximum(rise.max(axis=0), 0.0), rtol=1e-3, atol=1e-4)
    turned = np.where(m.h > 0.001, times[h.argmax(axis=0)], np.nan)
    np.testing.assert_allclose(m.time_of_max, turned, rtol=1e-6)
    spells = (wet[:-1] * np.diff(times)[:, None, None]).sum(axis=0)
    np.testing.assert_allclose(m.wet_duration, spells, atol=2e-3)
    assert 1.4 < m.wet_duration[10, 5] <= 1.5
    assert 0.0 < m.wet_duration[10, 21] < 1.5


def test_wet_time_adds_up_over_several_spells_and_stops_when_the_water_has_gone():
    s = dam_break(slope=0.05)
    s.advance_to(400.0)
    total, now_dry = s.maxima().wet_duration, s.depth() <= 0.01
    ends = now_dry & (total > 5.0)
    assert ends.any()
    assert total.max() == pytest.approx(400.0, rel=1e-5)
    s.advance_to(500.0)
    later = s.maxima().wet_duration
    stays = ends & (s.maxima().wet_duration == total)
    assert stays.sum() > 0.8 * ends.sum()
    assert later.max() == pytest.approx(500.0, rel=1e-5)


def test_a_lake_that_sleeps_is_wet_all_the_time():
    z = np.zeros((64, 64), np.float32)
    z[20:40, 20:40] = 3.0
    s = solver(FloodModel(5.0, z, 0.02), threads=1)
    s.set_water(np.maximum(2.0 - z, 0.0))
    s.advance_to(300.0)
    m = s.maxima()
    assert s.active_cells == 0
    assert (m.wet_duration[z == 0.0] == 300.0).all()
    assert not m.wet_duration[z > 0.0].any()
    assert not m.rise_rate_max.any()


def test_cells_that_an_edit_lifts_out_of_the_water_are_no_longer_wet():
    s = solver(FloodModel(5.0, np.zeros((32, 32), np.float32), 0.02), threads=1)
    s.set_water(np.full((32, 32), 1.0, np.float32))
    s.advance_to(50.0)
    bed = s.bed
    bed[:, :16] = 2.0
    s.replace_bed(bed)
    s.advance_to(80.0)
    m = s.maxima()
    assert (m.wet_duration[:, :15] == 50.0).all()
    assert (m.wet_duration[:, 17:] == 80.0).all()


def test_maxima_by_class_are_the_same_in_both_engines_and_across_a_snapshot():
    oracle, rows, other = (
        dam_break(arrival_depths=CLASSES, **params)
        for params in ({"engine": "kernels"}, {"engine": "rows", "threads": 2}, {})
    )
    rows.advance_to(9.0)
    other.restore(rows.snapshot())
    oracle.advance_to(9.0)
    for s in (oracle, rows, other):
        s.advance_to(25.0)
    assert differences(oracle, rows) == []
    assert differences(rows, other) == []
    deeper = [np.nan_to_num(rows.maxima().arrival_by_class[depth], nan=1e9) for depth in CLASSES]
    assert (deeper[0] <= deeper[1]).all()
    assert (deeper[1] < deeper[2]).any()


def test_a_snapshot_with_other_classes_is_refused():
    kept = dam_break(arrival_depths=CLASSES).snapshot()
    with pytest.raises(ModelError, match="class_arrival"):
        dam_break().restore(kept)


@pytest.mark.parametrize("depths", [(0.0,), (0.3, 0.3), (float("nan"),)])
def test_classes_that_are_not_valid_are_refused(depths):
    with pytest.raises(ModelError, match="arrival_depths"):
        SolverParams(arrival_depths=depths)
