"""Culverts and pumps on the device: discharges against their formulas, switching, volume, engines."""

import dataclasses
import math

import numpy as np
import pytest

from solver_service.numerics import FloodModel, ShallowWaterSolver, SolverParams
from solver_service.numerics.structures import Culvert, Pump
from tests.solver_service.numerics.floods import differences

DX = 20.0
SHAPE = (24, 40)
CREST = 20
"""Column of the bank between two basins."""


def basins(bed=0.0):
    """Two basins with a bank between them."""
    z = np.full(SHAPE, bed, np.float32)
    z[:, CREST] = 10.0
    return z


def levels(west, east, z):
    """Water at rest at these levels on either side of the bank."""
    eta = np.where(np.arange(SHAPE[1]) < CREST, west, east)
    return np.maximum(eta - z, 0.0).astype(np.float32)


CULVERT = Culvert("road", ((12, 18),), ((12, 22),), 0.5, 0.5, 1.5, 1.0, 40.0)


def solver(*structures, west=3.0, east=0.0, z=None, **params):
    z = basins() if z is None else z
    s = ShallowWaterSolver(
        FloodModel(DX, z, 0.03, structures=structures), SolverParams(threads=1, **params), "cpu"
    )
    s.set_water(levels(west, east, z))
    return s


def formula(culvert, up, down):
    """Discharge of a box culvert with level inverts by the formulas of the documentation."""
    head = up - culvert.invert_inlet
    free = (2.0 / 3.0) ** 1.5 * math.sqrt(9.81) * culvert.width * head**1.5
    orifice_head = max(head - 0.5 * culvert.height, 0.5 * head)
    area = culvert.width * culvert.height
    drowned = culvert.orifice_coefficient * area * math.sqrt(2.0 * 9.81 * orifice_head)
    y = min(head, culvert.height)
    fall = up - max(down, culvert.invert_outlet + 0.5 * y)
    full = culvert.width * y * math.sqrt(2.0 * 9.81 * fall / culvert.loss)
    return culvert.barrels * min(free, drowned, full)


@pytest.mark.parametrize(
    ("control", "culvert", "west", "east"),
    [
        ("free surface at the inlet", CULVERT, 1.2, 0.0),
        ("drowned inlet", CULVERT, 3.0, 0.0),
        ("full barrel", CULVERT, 3.0, 2.5),
        ("long rough barrel", dataclasses.replace(CULVERT, length=300.0, manning_n=0.03), 3.0, 0.0),
        ("two barrels", dataclasses.replace(CULVERT, barrels=2), 3.0, 0.0),
    ],
)
def test_a_culvert_discharges_by_its_formula(control, culvert, west, east):
    s = solver(culvert, west=west, east=east)
    s.advance_to(0.5)
    start = s.budget()
    up, down = (s.bed + s.depth())[12, 18], (s.bed + s.depth())[12, 22]
    s.advance_to(1.5)
    moved = s.budget().moved["road"] - start.moved["road"]
    expected = formula(culvert, up, down)
    assert expected > 0.1
    assert moved == pytest.approx(expected, rel=0.02), control
    assert s.conduit_states()[0].discharge == pytest.approx(expected, rel=0.02)


def test_the_three_controls_are_different_formulas():
    cases = [(1.2, 0.0), (3.0, 0.0), (3.0, 2.5)]
    free, drowned, full = (formula(CULVERT, *case) for case in cases)
    assert free == pytest.approx(1.7049 * 1.5 * 0.7**1.5, rel=1e-4)
    assert drowned == pytest.approx(0.6 * 1.5 * math.sqrt(2.0 * 9.81 * 2.0), rel=1e-4)
    assert full == pytest.approx(1.5 * math.sqrt(2.0 * 9.81 * 0.5 / CULVERT.loss), rel=1e-4)


def test_basins_joined_by_a_culvert_come_to_one_level_without_swinging():
    z = basins()
    z[:, :14] = z[:, 27:] = z[:8] = z[17:] = 10.0
    s = solver(dataclasses.replace(CULVERT, barrels=4), west=2.0, east=1.0, z=z)
    heads = []
    for time in range(20, 6000, 200):
        s.advance_to(float(time))
        eta = s.bed + s.depth()
        heads.append(float(eta[12, 18] - eta[12, 22]))
    assert heads[0] > 0.5
    assert abs(heads[-1]) < 0.02
    assert min(heads) > -0.02
    assert abs(s.budget().error_relative) < 1e-7


def test_water_below_the_invert_stays():
    s = solver(dataclasses.replace(CULVERT, invert_inlet=2.0, invert_outlet=1.0), west=1.9)
    s.advance_to(30.0)
    assert s.budget().moved["road"] == 0.0
    assert s.depth()[:, CREST + 1 :].max() == 0.0


@pytest.mark.parametrize(("both_ways", "sign"), [(True, -1), (False, 0)])
def test_a_flap_gate_lets_nothing_back(both_ways, sign):
    s = solver(dataclasses.replace(CULVERT, both_ways=both_ways), west=0.0, east=3.0)
    s.advance_to(30.0)
    assert np.sign(s.budget().moved["road"]) == sign
    assert bool(s.depth()[:, :CREST].max() > 0.0) is both_ways


PUMP = Pump("station", ((12, 10), (12, 11)), ((12, 30),), (0.0, 10.0), (4.0, 4.0), "level")


def test_a_pump_moves_its_rating_exactly():
    s = solver(PUMP, west=2.0)
    s.advance_to(100.0)
    budget = s.budget()
    assert budget.moved["station"] == pytest.approx(400.0, abs=DX * DX * 2.0**-15)
    assert s.depth()[:, CREST + 1 :].sum(dtype=float) * DX * DX == pytest.approx(400.0, abs=0.1)
    assert abs(budget.error_relative) < 1e-8


def test_a_pump_out_of_the_domain_is_booked_as_outflow():
    s = solver(dataclasses.replace(PUMP, outlet=None), west=2.0)
    s.advance_to(50.0)
    budget = s.budget()
    assert budget.structures["station"] == pytest.approx(200.0, abs=0.1)
    assert budget.outflow == budget.structures["station"]
    assert budget.initial - budget.stored == pytest.approx(200.0, abs=0.1)
    assert abs(budget.error_relative) < 1e-8


def test_a_rating_is_linear_between_its_entries_and_held_outside():
    for level, expected in ((0.5, 1.0), (2.0, 2.0), (3.5, 3.5), (5.0, 4.0)):
        rated = dataclasses.replace(PUMP, rating=(1.0, 3.0, 4.0), discharge=(1.0, 3.0, 4.0))
        s = solver(rated, west=level)
        s.advance_to(0.5)
        assert s.conduit_states()[0].discharge == pytest.approx(expected, rel=0.01)


def test_a_rating_against_head_counts_the_level_at_the_outlet_less_that_at_the_inlet():
    rated = dataclasses.replace(PUMP, rating=(0.0, 2.0), discharge=(4.0, 0.0), rating_against="head")
    for east, expected in ((1.0, 4.0), (2.0, 2.0), (3.0, 0.0)):
        s = solver(rated, west=1.0, east=east)
        s.advance_to(0.5)
        assert s.conduit_states()[0].discharge == pytest.approx(expected, abs=0.1)


def test_a_pump_starts_at_one_level_and_stops_at_a_lower_one():
    z = basins()
    z[:, :6] = z[:8] = z[17:] = 10.0
    switched = dataclasses.replace(PUMP, outlet=None, start_level=1.5, stop_level=1.0)
    s = solver(switched, west=1.4, z=z)
    s.advance_to(20.0)
    assert not s.conduit_states()[0].is_running
    assert s.budget().structures["station"] == 0.0
    s = solver(switched, west=1.6, z=z)
    seen = []
    for time in range(50, 15000, 50):
        s.advance_to(float(time))
        seen.append((float((s.bed + s.depth())[12, 10]), s.conduit_states()[0].is_running))
        if not seen[-1][1]:
            break
    assert seen[0][1]
    assert min(level for level, running in seen if running) < 1.1, "still runs between the two levels"
    assert not seen[-1][1]
    assert seen[-1][0] == pytest.approx(1.0, abs=0.05)


def test_a_pump_takes_no_more_than_there_is():
    z = basins()
    z[:] = 10.0
    z[12, 10:12] = 0.0
    z[:, 25:] = 0.0
    s = solver(dataclasses.replace(PUMP, discharge=(500.0, 500.0)), west=0.5, z=z)
    s.advance_to(60.0)
    depth = s.depth()
    assert depth.min() >= 0.0
    assert depth[12, 10:12].max() < 1e-3
    assert s.budget().moved["station"] == pytest.approx(0.5 * 2 * DX * DX, rel=2e-3)
    assert abs(s.budget().error_relative) < 1e-7


def chain():
    """Two culverts and a pump that share cells, another pump apart."""
    second = dataclasses.replace(CULVERT, id="second", inlet=((12, 22),), outlet=((4, 30), (4, 31)))
    lift = Pump("lift", ((4, 30),), ((12, 18),), (0.0, 3.0), (2.0, 0.5), "head", 0.2, 0.1)
    apart = dataclasses.replace(PUMP, inlet=((20, 3),), outlet=None)
    return (second, apart, lift, CULVERT)


def test_rows_kernels_and_a_split_run_give_the_same_bits():
    runs = [solver(*chain(), east=0.8, engine=engine) for engine in ("rows", "kernels", "tiles")]
    for s in runs:
        s.advance_to(40.0)
    later = solver(*chain(), east=0.8)
    later.restore(runs[0].snapshot())
    for s in (*runs, later):
        s.advance_to(90.0)
    for other in (*runs[1:], later):
        assert differences(runs[0], other) == []
        assert other.conduit_states() == runs[0].conduit_states()
    assert all(state.moved > 0.0 for state in later.conduit_states())
    assert abs(later.budget().error_relative) < 1e-7
