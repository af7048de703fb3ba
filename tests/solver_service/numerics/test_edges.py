"""Edges in a flood: still water stays still, series are met, volumes are booked."""

import dataclasses

import numpy as np
import pytest

from solver_service.numerics import FloodModel
from solver_service.numerics.edges import critical_rating, segment_names
from tests.solver_service.numerics.edge_models import channel, edge, everywhere
from tests.solver_service.numerics.floods import bed, differences, full_model, solver, wild_water

G = 9.81

MIXED = (
    edge("west", "stage", 5, 30, id="tide", times=[0.0, 3.0, 8.0], values=[2.2, 3.0, 1.5]),
    edge("west", "open", 30, 45, id="gap"),
    edge("east", "discharge", 10, 50, id="river", times=[0.0, 2.0, 6.0], values=[0.0, 90.0, 30.0]),
    edge("north", "normal_depth", 20, 60, id="plain", slope=0.01),
    edge("south", "discharge", 15, 40, id="pumped", times=[0.0], values=[-25.0]),
    edge("south", "open", 0, 15, id="corner"),
)


def mixed_flood(**params):
    model = dataclasses.replace(full_model(), boundaries=MIXED)
    s = solver(model, **params)
    s.set_water(*wild_water(model.z_b))
    return s


def volumes(s):
    return {name: list(pair) for name, pair in s.budget().edges.items()}


# --- still water -----------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", ["open", "stage", "discharge"])
def test_a_lake_among_hills_stays_exactly_at_rest(kind):
    z = bed((40, 50), roughness=0.3)
    level = 0.35
    kw = {
        "open": {},
        "stage": {"times": [0.0], "values": [level]},
        "discharge": {"times": [0.0], "values": [0.0]},
    }
    s = solver(FloodModel(5.0, z, 0.03, boundaries=everywhere(kind, 40, 50, **kw[kind])), threads=1)
    h = np.maximum(level - z, 0.0)
    s.set_water(h)
    s.advance_to(60.0)
    assert not any(part.any() for part in s.velocity())
    assert np.array_equal(s.depth(), h.astype(np.float32))


def test_a_stage_a_millimetre_off_moves_the_lake():
    s = channel(200.0, 5.0, (edge("west", "stage", 0, 2, times=[0.0], values=[2.001]),))
    s.set_water(np.full((2, 40), 2.0))
    s.advance_to(5.0)
    assert abs(s.velocity()[0]).max() > 1e-4


def test_a_lake_whose_ground_is_raised_at_an_open_edge_stays_at_rest():
    z = np.zeros((10, 20), np.float32)
    s = solver(FloodModel(5.0, z, 0.03, boundaries=everywhere("open", 10, 20)), threads=1)
    s.set_water(np.full(z.shape, 1.0))
    z[:, -1] = 0.25
    s.replace_bed(z)
    s.advance_to(30.0)
    assert not s.velocity()[0].any()


def test_a_lake_beside_a_normal_depth_drains():
    s = channel(100.0, 5.0, (edge("east", "normal_depth", 0, 2, slope=0.001),), manning_n=0.03)
    s.set_water(np.full((2, 20), 1.0))
    s.advance_to(120.0)
    assert s.budget().outflow > 0.3 * s.budget().initial


@pytest.mark.parametrize("kind", ["open", "normal_depth", "stage", "discharge"])
def test_the_thinnest_film_on_a_slope_at_an_edge_stays_finite(kind):
    series = {"times": [0.0], "values": [0.3]}
    kw = {"open": {}, "normal_depth": {"slope": 0.01}, "stage": series, "discharge": series}
    s = channel(50.0, 5.0, everywhere(kind, 2, 10, **kw[kind]), 0.1 * np.arange(10), 0.03)
    s.set_water(np.full((2, 10), 1e-35))
    s.advance_to(20.0)
    assert np.isfinite(s.depth()).all()
    assert abs(s.budget().error_relative) < 1e-6


# --- walls and open edges ----------------------------------------------------------------------------


def test_an_open_edge_never_lets_water_in():
    z = bed()
    s = solver(FloodModel(5.0, z, 0.03, boundaries=everywhere("open", *z.shape)), threads=1)
    s.set_water(*wild_water(z))
    s.advance_to(20.0)
    assert all(came == 0.0 for came, _ in s.budget().edges.values())
    assert s.budget().outflow > 1000.0


def test_walls_beside_segments_and_round_corners_are_tight():
    z = bed((12, 14), roughness=0.1)
    s = solver(FloodModel(5.0, z, 0.03, boundaries=(edge("north", "open", 3, 14),)), threads=1)
    s.set_water(*wild_water(z))
    s.advance_to(10.0)
    flow = s._store.edge_flow.numpy().copy()
    assert flow[3, 3:].min() > 0.0
    flow[3, 3:] = 0.0
    assert not flow.any()


# --- stage ------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def beach():
    """Levels, and depth at the sea, of a tide that runs up a beach and falls below its lowest cell."""
    times = np.arange(0.0, 1400.0, 10.0)
    tide = 2.5 * np.sin(2.0 * np.pi * times / 1000.0)
    z = -2.0 + 0.05 * np.arange(80)
    s = channel(800.0, 10.0, (edge("west", "stage", 0, 2, id="sea", times=times, values=tide),), z, 0.02)
    s.set_water(np.broadcast_to(np.maximum(-z, 0.0), (2, 80)))
    seen = {}
    for time in (250.0, 750.0, 1250.0):
        s.advance_to(time)
        seen[time] = s.depth()[0].copy()
    return s, seen


def test_a_tide_floods_dry_ground_and_comes_again(beach):
    s, seen = beach
    assert seen[250.0][0] == pytest.approx(4.5, abs=0.02)
    assert np.count_nonzero(seen[250.0] > 0.01) > 50
    assert seen[1250.0][0] == pytest.approx(4.5, abs=0.02)
    assert abs(s.budget().error_relative) < 1e-7


def test_a_tide_below_the_bed_lets_the_water_fall_off(beach):
    _, seen = beach
    assert 0.0 < seen[750.0][0] < 1.0
    assert np.count_nonzero(seen[750.0] > 0.01) < np.count_nonzero(seen[250.0] > 0.01)


# --- discharge --------------------------------------------------------------------------------------


def valley(values, times, rows=30, cols=40, dx=10.0):
    y, x = np.mgrid[0:rows, 0:cols]
    z = 0.3 * abs(y - 15) + 0.02 * x[:, ::-1] + 0.1 * np.random.default_rng(0).random((rows, cols))
    boundaries = (
        edge("west", "discharge", 0, rows, id="in", times=times, values=values),
        edge("east", "normal_depth", 0, rows, id="out", slope=0.002),
    )
    return solver(FloodModel(dx, z, 0.035, boundaries=boundaries), threads=1)


def test_a_hydrograph_brings_its_volume_without_drift():
    times, values = [0.0, 100.0, 400.0, 900.0], [0.0, 0.0, 80.0, 20.0]
    s = valley(values, times)
    for time in (90.0, 300.0, 600.0, 900.0, 1500.0):
        s.advance_to(time)
        t = np.linspace(0.0, time, 30001)
        q = np.interp(t, times, values)
        came, left = s.budget().edges["in"]
        assert came - left == pytest.approx(np.trapezoid(q, t), abs=0.1 * max(q[-1], 1.0) * s.dt + 0.1)
        assert abs(s.budget().error_relative) < 1e-7
    assert s.budget().edges["out"][1] > 1e4


@pytest.mark.parametrize(
    ("times", "values"),
    [([-20.0, 30.0], [1.0, 6.0]), ([20.0, 40.0], [3.0, 5.0]), ([0.0], [4.0]), ([-9.0, -3.0], [5.0, 2.0])],
)
def test_a_series_holds_before_its_first_and_after_its_last_time(times, values):
    boundaries = (edge("west", "discharge", 0, 2, id="in", times=times, values=values),)
    s = channel(100.0, 5.0, boundaries, manning_n=0.03)
    s.set_water(np.full((2, 20), 1.5))
    for time in (10.0, 60.0):
        s.advance_to(time)
        t = np.linspace(0.0, time, 60001)
        came, left = s.budget().edges["in"]
        assert came - left == pytest.approx(np.trapezoid(np.interp(t, times, values), t), rel=4e-3)


def test_the_first_water_takes_the_lowest_cells_and_no_giant_step():
    s = valley([0.0, 0.0, 60.0], [0.0, 100.0, 100.001])
    s.advance_to(100.0)
    assert s.dt > 3.0
    assert not s.depth().any()
    s.advance_to(104.0)
    wet = np.flatnonzero(s.depth()[:, 0] > 0.01)
    assert wet.size
    assert abs(wet - 15).max() <= 6
    s.advance_to(400.0)
    assert s.maxima().h.max() < 1.1 * s.depth().max() + 0.3


def test_a_negative_discharge_takes_water_out_as_far_as_there_is_any():
    lake = np.zeros((30, 30), np.float32)
    for q, is_met in ((-8.0, True), (-60.0, False)):
        boundaries = (edge("north", "discharge", 5, 15, id="pump", times=[0.0], values=[q]),)
        s = solver(FloodModel(5.0, lake, 0.03, boundaries=boundaries), threads=1)
        s.set_water(np.full(lake.shape, 0.5))
        s.advance_to(60.0)
        came, left = s.budget().edges["pump"]
        unmet = s.unmet_outflow()["pump"]
        assert came == 0.0
        assert left + unmet == pytest.approx(-60.0 * q, rel=2e-2)
        assert (unmet < 1.0) is is_met
        assert s.depth().min() > 0.0


def test_a_hydrograph_that_has_ended_leaves_a_wall():
    boundaries = (
        edge("west", "discharge", 0, 2, id="in", times=[0.0, 10.0, 10.001], values=[6.0, 6.0, 0.0]),
    )
    s = channel(100.0, 5.0, boundaries, manning_n=0.05)
    s.set_water(np.full((2, 20), 1.0))
    s.advance_to(3000.0)
    before = volumes(s)
    s.advance_to(3300.0)
    assert volumes(s) == before
    assert before["in"][0] - before["in"][1] == pytest.approx(60.0, abs=0.05)


def test_the_rating_of_critical_flow_is_that_of_a_rectangle():
    levels, discharges = critical_rating(np.full(10, 3.0, np.float32), 2.0, 50.0)
    assert discharges[-1] == pytest.approx(50.0, rel=1e-5)
    assert discharges == pytest.approx(20.0 * np.sqrt(G) * (levels - 3.0) ** 1.5, rel=1e-4, abs=1e-5)


# --- all kinds at once ------------------------------------------------------------------------------


def test_every_engine_gives_the_same_bits_with_every_kind():
    runs = [
        mixed_flood(**kw)
        for kw in ({"engine": "kernels"}, {"engine": "tiles"}, {"threads": 1}, {"threads": 3})
    ]
    for s in runs:
        s.advance_to(1.3)
        s.advance_to(9.0)
    for s in runs[1:]:
        assert differences(runs[0], s) == []
        assert volumes(runs[0]) == volumes(s)
    assert runs[0].step_count > 20


@pytest.mark.parametrize("engine", ["rows", "kernels"])
def test_a_split_run_equals_the_whole_with_every_kind(engine):
    whole, first, second = (mixed_flood(engine=engine) for _ in range(3))
    first.advance_to(3.0)
    second.restore(first.snapshot())
    whole.advance_to(3.0)
    for s in (whole, second):
        s.advance_to(8.0)
    assert differences(whole, second) == []
    assert volumes(whole) == volumes(second)
    assert whole.unmet_outflow() == second.unmet_outflow()


def test_the_budget_closes_with_every_kind():
    s = mixed_flood(threads=1)
    s.advance_to(60.0)
    budget = s.budget()
    assert abs(budget.error_relative) < 1e-7
    assert set(budget.edges) == {"tide", "gap", "river", "plain", "pumped", "corner"}
    assert budget.edges["tide"][0] > 50.0
    assert budget.edges["river"][0] > 100.0
    assert budget.edges["gap"][0] == budget.edges["plain"][0] == 0.0


def test_unnamed_segments_are_named_by_their_place():
    boundaries = (
        edge("west", "open", 0, 2),
        edge("west", "wall", 2, 3),
        edge("east", "open", 0, 2, id="sea"),
    )
    assert segment_names((*boundaries, edge("west", "open", 3, 5))) == ("west-1", "sea", "west-2")
