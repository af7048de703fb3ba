"""What the ground takes: each law against its exact solution, every drop booked, none that is not there."""

import numpy as np
import pytest
from scipy.optimize import brentq

from solver_service.numerics import FloodModel, Infiltration, ModelError, Rain, Source
from tests.solver_service.numerics.floods import differences, solver

SHAPE = (20, 40)
QUANTUM = 2.0**-20


def pond(infiltration, depth=1.0, **params):
    """Level water over flat ground."""
    model = FloodModel(5.0, np.zeros(SHAPE, np.float32), 0.03, infiltration=infiltration)
    s = solver(model, threads=1, **params)
    s.set_water(np.full(SHAPE, depth, np.float32))
    return s


def soaked(s):
    """Mean depth infiltrated [m]; nothing else has gone."""
    budget, cells = s.budget(), SHAPE[0] * SHAPE[1]
    assert budget.error == 0.0
    return budget.infiltration / (cells * 25.0)


@pytest.mark.parametrize("depth", [0.3, 2.0, 50.0])
def test_a_constant_rate_takes_rate_times_time_however_deep_the_water(depth):
    s = pond(Infiltration("constant", None, {"rate": 1e-5}), depth)
    s.advance_to(200.0)
    quantum = QUANTUM if depth < 8.0 else 16 * QUANTUM
    assert soaked(s) == pytest.approx(2e-3, abs=quantum)


def test_a_capacity_ends_it():
    s = pond(Infiltration("constant", None, {"rate": 1e-4, "capacity": 5e-3}))
    s.advance_to(200.0)
    assert soaked(s) == pytest.approx(5e-3, abs=2 * QUANTUM)


@pytest.mark.parametrize("fc", [0.0, 3e-6, 3e-5])
def test_horton_takes_the_integral_of_its_rate(fc):
    f0, k = 3e-5, 1e-2
    s = pond(Infiltration("horton", None, {"f0": f0, "fc": fc, "k": k}))
    for time in (10.0, 100.0, 600.0):
        s.advance_to(time)
        exact = fc * time + (f0 - fc) / k * -np.expm1(-k * time)
        assert soaked(s) == pytest.approx(exact, abs=2 * QUANTUM)


def test_horton_ground_that_stayed_dry_is_as_thirsty_as_at_the_start():
    law = Infiltration("horton", None, {"f0": 3e-5, "fc": 0.0, "k": 1e-2})
    wall = np.zeros(SHAPE, np.float32)
    wall[:, 20] = 5.0
    h = np.where(np.arange(SHAPE[1]) < 20, np.ones(SHAPE), 0.0)
    late = Source([5], [30], [300.0, 300.001, 310.0, 310.001], [0.0, 1000.0, 1000.0, 0.0])
    s = solver(FloodModel(5.0, wall, 0.03, sources=(late,), infiltration=law), threads=1)
    s.set_water(h)
    s.advance_to(300.0)
    before = s.budget().infiltration
    s.advance_to(330.0)
    # Twenty columns of wet ground west of the wall are nearly full; nineteen east of it begin with f0.
    taken = (s.budget().infiltration - before) / (19 * SHAPE[0] * 25.0)
    assert taken > 0.6 * 3e-5 * 25.0
    assert before / (20 * SHAPE[0] * 25.0) == pytest.approx(3e-3 * -np.expm1(-3.0), rel=1e-2)


@pytest.mark.parametrize("depth", [0.05, 1.0, 5.0])
def test_green_ampt_follows_the_implicit_solution_of_a_falling_pond(depth):
    conductivity, suction, deficit = 3e-6, 0.11, 0.3
    numbers = {"conductivity": conductivity, "suction": suction, "deficit": deficit}
    s = pond(Infiltration("green_ampt", None, numbers), depth)
    # With h = h0 - F: dF/dt = K (a F + b) / F, a = 1 - deficit, b = (psi + h0) deficit.
    a, b = 1.0 - deficit, (suction + depth) * deficit

    def time_of(infiltrated):
        return (infiltrated / a - b / a**2 * np.log1p(a * infiltrated / b)) / conductivity

    for time in (10.0, 100.0, 600.0):
        s.advance_to(time)
        exact = brentq(lambda infiltrated, t=time: time_of(infiltrated) - t, 1e-9, depth)
        assert soaked(s) == pytest.approx(exact, rel=1e-4, abs=2 * QUANTUM)


def test_ground_takes_no_more_than_there_is_and_leaves_no_velocity_in_what_is_left():
    s = pond(Infiltration("constant", None, {"rate": 1e-3}), 0.02)
    s.advance_to(60.0)
    assert soaked(s) == pytest.approx(0.02, abs=1.1e-5)
    assert s.depth().min() >= 0.0
    assert s.depth().max() <= s.params.depth_film
    assert not any(part.any() for part in s.velocity())


def test_each_zone_has_its_own_numbers():
    zone = np.zeros(SHAPE, np.int32)
    zone[:, 20:] = 1
    z = np.zeros(SHAPE, np.float32)
    z[:, 19:21] = 3.0
    law = Infiltration("constant", zone, {"rate": [1e-5, 4e-5]})
    s = solver(FloodModel(5.0, z, 0.03, infiltration=law), threads=1)
    s.set_water(np.where(z > 0.0, 0.0, 1.0))
    s.advance_to(100.0)
    assert s.depth()[10, 5] == pytest.approx(1.0 - 1e-3, abs=2 * QUANTUM)
    assert s.depth()[10, 35] == pytest.approx(1.0 - 4e-3, abs=2 * QUANTUM)


def test_rain_weaker_than_the_ground_leaves_no_runoff():
    rain = Rain.uniform(0.0, 1e-5, SHAPE)
    law = Infiltration("constant", None, {"rate": 2e-5})
    s = solver(FloodModel(5.0, np.zeros(SHAPE, np.float32), 0.03, rain=rain, infiltration=law), threads=1)
    s.advance_to(300.0)
    assert s.depth().max() < 4e-5
    assert s.budget().infiltration > 0.98 * s.budget().rain
    assert abs(s.budget().error_relative) < 1e-7


def sloshing(law, **params):
    x = np.arange(SHAPE[1], dtype=np.float32)
    z = np.tile(0.02 * x, (SHAPE[0], 1))
    s = solver(FloodModel(5.0, z, 0.03, infiltration=law), **params)
    s.set_water(np.where(x < 15, np.ones(SHAPE), 0.0))
    return s


LAWS = [
    Infiltration("constant", None, {"rate": 1e-3, "capacity": 1e-2}),
    Infiltration("horton", None, {"f0": 3e-3, "fc": 1e-4, "k": 1e-1}),
    Infiltration("green_ampt", None, {"conductivity": 1e-4, "suction": 0.2, "deficit": 0.4}),
]


@pytest.mark.parametrize("law", LAWS)
def test_engines_threads_pauses_and_snapshots_give_the_same_bits(law):
    oracle, rows, paused = (
        sloshing(law, **params)
        for params in ({"engine": "kernels"}, {"engine": "rows", "threads": 3}, {"threads": 1})
    )
    paused.advance_to(7.0, iter([False, True]).__next__)
    other = sloshing(law, threads=1)
    other.restore(paused.snapshot())
    for s in (oracle, rows, other):
        s.advance_to(7.0)
        s.advance_to(40.0)
    assert differences(oracle, rows) == []
    assert differences(oracle, other) == []
    assert abs(oracle.budget().error_relative) < 1e-7
    assert oracle.budget().infiltration > 0.005 * oracle.budget().initial


ZONE = np.zeros((4, 5), np.int32)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("sponge", None, {}), "'sponge'"),
        (("constant", None, {}), "parameters"),
        (("horton", None, {"f0": 1e-5, "fc": 1e-6}), "f0, fc, k are allowed"),
        (("horton", None, {"f0": 1e-6, "fc": 1e-5, "k": 1.0}), "fc <= f0"),
        (("constant", None, {"rate": -1e-6}), "rate of zone 0 is -1e-06"),
        (("constant", ZONE, {"rate": [1e-6, np.nan]}), "rate of zone 1 is nan"),
        (("constant", ZONE, {"rate": [1e-6, 1e-6], "capacity": [1.0]}), "capacity has 1 zones; 2"),
        (("constant", None, {"rate": [1e-6, 1e-6]}), "no zone raster"),
        (("constant", ZONE + 1, {"rate": [1e-6]}), r"zone is 1 in cell \(row 0, column 0\); 0 to 0"),
        (("green_ampt", None, {"conductivity": 1e-6, "suction": 0.1, "deficit": 1.2}), "0 to 1"),
    ],
)
def test_what_is_not_valid_is_refused_in_one_sentence(arguments, words):
    with pytest.raises(ModelError, match=words) as caught:
        Infiltration(*arguments)
    assert "\n" not in str(caught.value)


def test_zones_of_another_grid_are_refused():
    law = Infiltration("constant", ZONE, {"rate": 0.0})
    with pytest.raises(ModelError, match="zones have the shape"):
        FloodModel(5.0, np.zeros(SHAPE), 0.03, infiltration=law)
