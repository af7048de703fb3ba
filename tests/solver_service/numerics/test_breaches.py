"""Breaches on the device: widths against their law, the bed they leave, edits, snapshots, engines."""

import dataclasses
import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from solver_service.errors import ModelError
from solver_service.numerics import FloodModel, ShallowWaterSolver, SolverParams
from solver_service.numerics.breach import Breach
from tests.solver_service.numerics.floods import differences

DX = 10.0
SHAPE = (30, 40)
LEVEE = 19
"""Row of the levee."""


def levee_bed(top=5.0):
    """A flat plain with a levee, one row of cells, from west to east."""
    z = np.zeros(SHAPE, np.float32)
    z[LEVEE] = top
    return z


def pond(z, level=4.0):
    """Water at rest north of the levee."""
    h = np.zeros(SHAPE, np.float32)
    h[LEVEE + 1 :] = level - z[LEVEE + 1 :]
    return h


BREACH = Breach("dyke", ((4.5, LEVEE), (34.5, LEVEE)), 5.0, 1.0, 60.0, 20.0, 200.0, start_time=10.0)


def solver(*breaches, z=None, **params):
    model = FloodModel(DX, levee_bed() if z is None else z, 0.03, breaches=breaches)
    s = ShallowWaterSolver(model, SolverParams(threads=1, **params), "cpu")
    s.set_water(pond(model.z_b))
    return s


def test_a_breach_grows_linearly_from_its_start_time_and_the_pond_runs_out():
    s = solver(BREACH)
    s.advance_to(9.9)
    assert s.breach_states()[0].started_at is None
    assert np.array_equal(s.bed, levee_bed())
    assert s.depth()[:LEVEE].max() == 0.0
    s.advance_to(40.0)
    state = s.breach_states()[0]
    assert state.started_at == 10.0
    assert state.width == pytest.approx(20.0 + 0.5 * 180.0)
    assert state.level == pytest.approx(3.0)
    s.advance_to(120.0)
    state = s.breach_states()[0]
    assert (state.width, state.level) == (200.0, 1.0)
    bed = s.bed[LEVEE]
    assert (bed[10:29] == 1.0).all(), "cells inside 200 m around the middle at 19.5"
    assert bed[9] == 5.0
    assert bed[30] == 5.0
    assert s.depth()[:LEVEE].max() > 0.5
    assert abs(s.budget().error_relative) < 1e-7


def test_without_a_breach_the_levee_holds():
    s = solver()
    s.advance_to(120.0)
    assert s.breach_states() == ()
    assert s.depth()[:LEVEE].max() == 0.0


def test_the_opening_is_a_trapezoid_whose_area_is_cut_from_the_bed():
    sloped = dataclasses.replace(
        BREACH, side_slope=4.0, width_final=100.0, vertices=((2.0, LEVEE), (37.0, LEVEE))
    )
    s = solver(sloped)
    s.advance_to(100.0)
    cut = (levee_bed()[LEVEE].astype(float) - s.bed[LEVEE]) * DX
    assert cut.sum() == pytest.approx(100.0 * 4.0 + 4.0 * 4.0**2)
    centres = (np.arange(SHAPE[1]) - 19.5) * DX
    inside = np.abs(centres) + 0.5 * DX <= 50.0
    sides = (np.abs(centres) > 56.0) & (np.abs(centres) < 61.0)
    assert np.allclose(s.bed[LEVEE][inside], 1.0)
    assert np.allclose(s.bed[LEVEE][sides], 1.0 + (np.abs(centres[sides]) - 50.0) / 4.0, atol=1e-5)


def test_overtopping_starts_when_water_beside_the_line_stands_above_the_crest():
    waiting = dataclasses.replace(BREACH, start="overtopping", start_time=0.0)
    s = solver(waiting)
    s.advance_to(30.0)
    assert s.breach_states()[0].started_at is None
    s.set_water(pond(levee_bed(), level=5.05))
    s.advance_to(30.0)
    assert s.breach_states()[0].started_at == pytest.approx(0.0, abs=1.0)
    s = solver(dataclasses.replace(waiting, start_time=12.0))
    s.set_water(pond(levee_bed(), level=5.3))
    s.advance_to(30.0)
    assert 12.0 <= s.breach_states()[0].started_at < 13.0, "never before the start time"


def verheij_width(head, seconds, critical, f1=1.3, f2=0.04, first=20.0):
    """Width at times since the widening began, for a head [m] as a function of time, by scipy."""

    def rate(t, _):
        hours = t / 3600.0
        lift = (9.81 * head(t)) ** 1.5 / critical**2
        return f1 * f2 / math.log(10.0) * lift / (1.0 + f2 * 9.81 / critical * hours) / 3600.0

    return solve_ivp(rate, (0.0, seconds[-1]), [first], t_eval=seconds, rtol=1e-9, atol=1e-9).y[0]


def test_the_width_follows_verheij_and_van_der_knaap_with_the_falling_head():
    changes = {"law": "verheij_van_der_knaap", "width_final": None, "critical_velocity": 0.1}
    grown = dataclasses.replace(BREACH, start_time=0.0, duration=5.0, **changes)
    s = solver(grown)
    (north, south) = sorted(grown.probes(DX), reverse=True)
    times = np.arange(5.0, 300.0, 1.0)
    heads, widths = [], []
    for time in times:
        s.advance_to(time)
        eta = s.bed + s.depth()
        heads.append(max(eta[north], 1.0) - max(eta[south], 1.0))
        widths.append(s.breach_states()[0].width)
    assert s.breach_states()[0].level == 1.0
    expected = verheij_width(lambda t: np.interp(t, times - 5.0, heads), times - 5.0, critical=0.1)
    assert widths[0] == 20.0
    assert widths[-1] > 30.0
    assert np.abs(np.array(widths) - expected).max() < 0.005 * (expected[-1] - 20.0)
    slower = verheij_width(lambda t: np.interp(t, times - 5.0, heads), times - 5.0, critical=0.12)
    assert np.abs(np.array(widths) - slower).max() > 0.1 * (expected[-1] - 20.0), "the law is sharp enough"


def test_the_width_stops_at_its_largest():
    grown = dataclasses.replace(
        BREACH,
        law="verheij_van_der_knaap",
        width_final=25.0,
        start_time=0.0,
        duration=5.0,
        critical_velocity=0.05,
    )
    s = solver(grown)
    s.advance_to(200.0)
    assert s.breach_states()[0].width == 25.0


def test_an_edit_on_the_breach_is_eaten_and_one_beside_it_stays():
    s = solver(BREACH)
    s.advance_to(45.0)
    level, width = s.breach_states()[0].level, s.breach_states()[0].width
    edited = levee_bed(top=7.0)
    edited[LEVEE - 4] = 6.0
    change = s.replace_bed(edited)
    bed = s.bed
    assert change.changed_cells > 0
    assert (bed[LEVEE - 4] == 6.0).all()
    assert bed[LEVEE, 2] == 7.0
    assert bed[LEVEE, 19] == pytest.approx(level)
    assert (s.breach_states()[0].level, s.breach_states()[0].width) == (level, width)
    s.advance_to(120.0)
    assert abs(s.budget().error_relative) < 1e-7


def test_lowering_keeps_the_water_column_and_books_nothing():
    s = solver(dataclasses.replace(BREACH, duration=1e-3, start_time=0.0))
    before = s.budget().stored
    s.advance_to(1.0)
    assert s.bed[LEVEE, 19] == 1.0
    budget = s.budget()
    assert budget.edits == 0.0
    assert budget.stored == pytest.approx(before, rel=1e-7)


def test_beginning_anew_restores_the_levee():
    s = solver(BREACH)
    s.advance_to(60.0)
    s.set_water(pond(levee_bed()))
    assert np.array_equal(s.bed, levee_bed())
    assert s.breach_states()[0].started_at is None


@pytest.mark.parametrize("engine", ["rows", "kernels"])
def test_a_split_run_with_an_edit_equals_the_whole_bit_for_bit(engine):
    breaches = (BREACH,)
    whole, part = solver(*breaches, engine=engine), solver(*breaches, engine=engine)
    edited = levee_bed()
    edited[LEVEE - 5, 10:30] = 2.0
    whole.advance_to(30.0)
    whole.replace_bed(edited)
    whole.advance_to(42.0)
    part.restore(whole.snapshot())
    for s in (whole, part):
        s.advance_to(55.0)
        s.replace_bed(levee_bed())
        s.advance_to(80.0)
    assert differences(whole, part) == []
    assert whole.breach_states() == part.breach_states()


def test_breaches_that_share_a_cell_are_refused():
    with pytest.raises(ModelError, match="'dyke' and 'second' both reach cell"):
        solver(BREACH, dataclasses.replace(BREACH, id="second", start_time=500.0))


def test_the_breached_bed_is_what_a_breach_has_lowered_until_now_and_comes_back_with_a_snapshot():
    s = solver(BREACH)
    s.advance_to(9.9)
    cells, bed = s.breached_bed()
    assert cells.size == bed.size == 0
    s.advance_to(40.0)
    cells, bed = s.breached_bed()
    now, before = s.bed.reshape(-1), levee_bed().reshape(-1)
    assert np.array_equal(cells, np.flatnonzero(now < before))
    assert cells.size > 5
    assert np.array_equal(bed, now[cells])
    restored = solver(BREACH)
    restored.restore(s.snapshot())
    for mine, theirs in zip(restored.breached_bed(), (cells, bed), strict=True):
        assert np.array_equal(mine, theirs)
    assert solver().breached_bed()[0].size == 0


def test_the_breached_bed_of_an_edited_levee_is_told_against_the_edit():
    s = solver(BREACH)
    s.advance_to(40.0)
    edited = levee_bed(6.0)
    s.replace_bed(edited)
    cells, bed = s.breached_bed()
    whole = edited.reshape(-1).copy()
    whole[cells] = bed
    assert np.array_equal(whole.reshape(SHAPE), s.bed)
