"""The exact solutions with friction, beds and rain are judged before they judge the solver."""

from dataclasses import replace

import numpy as np
import pytest

from tests.validation.equations import residual
from tests.validation.solutions import CHANNELS, Bump, Dressler, MacDonald, RainOnPlane, Ritter
from tests.validation.solutions.dressler import corrections

BUMPS = {
    "subcritical": Bump("subcritical", 4.42, 2.0),
    "transcritical": Bump("transcritical", 1.53, 0.66),
    "jump": Bump("jump", 0.18, 0.33),
}
PLANE = RainOnPlane(length=200.0, slope=0.05, manning_n=0.05, rain=100.0 / 3.6e6, rain_end=1200.0)
SOAKING = replace(PLANE, infiltration=30.0 / 3.6e6)


def places(solution, *kinks):
    """Random places along the channel, off its ends, its kinks and its jump."""
    x = np.random.default_rng(7).uniform(0.002 * solution.length, 0.998 * solution.length, 400)
    near = [np.abs(x - at) < 2e-3 * solution.length for at in (solution.jump, *kinks)]
    return x[~np.any(near, axis=0)]


@pytest.mark.parametrize("name", CHANNELS)
def test_macdonald_channel_satisfies_the_equations_with_friction_and_rain(name):
    x = places(CHANNELS[name])
    assert residual(CHANNELS[name], x, 0.0 * x, 0.0) < 2e-6


@pytest.mark.parametrize("name", BUMPS)
def test_flow_over_the_bump_satisfies_the_equations(name):
    x = places(BUMPS[name], 8.0, 10.0, 12.0)
    assert residual(BUMPS[name], x, 0.0 * x, 0.0, step=1e-4) < 2e-6


@pytest.mark.parametrize("wrong", [{"manning_n": 0.0331}, {"discharge": 1.003}, {"rain": 0.00101}])
def test_wrong_roughness_discharge_or_rain_has_a_residual_that_shows_it(wrong):
    right = CHANNELS["subcritical with rain"]

    class Mistaken(MacDonald):
        def bed(self, x, y):
            return right.bed(x, y)

    fields = {k: getattr(right, k) for k in ("length", "discharge", "manning_n", "profile", "rain")}
    x = places(right)
    assert residual(Mistaken(**(fields | wrong)), x, 0.0 * x, 0.0) > 1e-4


@pytest.mark.parametrize("solution", [*CHANNELS.values(), *BUMPS.values()], ids=[*CHANNELS, *BUMPS])
def test_momentum_is_kept_across_jumps_and_depth_where_there_is_none(solution):
    at = solution.jump if np.isfinite(solution.jump) else 0.5 * solution.length
    x = at + np.array([-1e-9, 1e-9])
    (before, after), speed, _ = solution.state(x, 0.0 * x, 0.0)
    push = before * speed[0] ** 2 - after * speed[1] ** 2 + 0.5 * solution.gravity * (before**2 - after**2)
    assert abs(push) < 1e-4 * solution.gravity * after**2
    drops = speed[0] ** 2 > solution.gravity * before and speed[1] ** 2 < solution.gravity * after
    assert drops == (after > 1.1 * before)


def test_regimes_are_what_their_names_say():
    def froude(solution):
        x = np.linspace(0.0, solution.length, 1001)
        h, u, _ = solution.state(x, 0.0 * x, 0.0)
        return u / np.sqrt(solution.gravity * h)

    assert froude(CHANNELS["subcritical"]).max() < 1.0 < froude(CHANNELS["supercritical"]).min()
    for name in ("sub- to supercritical", "short, smooth transition"):
        assert froude(CHANNELS[name])[0] < 1.0 < froude(CHANNELS[name])[-1]
    assert froude(CHANNELS["super- to subcritical"])[0] > 1.0 > froude(CHANNELS["super- to subcritical"])[-1]
    assert froude(BUMPS["subcritical"]).max() < 1.0 < froude(BUMPS["transcritical"])[-1]
    assert froude(BUMPS["jump"])[-1] < 1.0 < froude(BUMPS["jump"]).max()


def test_jump_behind_the_bump_stands_where_swashes_puts_it():
    assert BUMPS["jump"].jump == pytest.approx(11.6655, abs=5e-4)


def test_dressler_with_chezy_friction_has_the_printed_corrections():
    ratio = np.linspace(-1.0, 1.5, 50)  # x / (c t)
    celerity, velocity = corrections((2.0 - ratio) / 3.0, power=2.0)
    w = 2.0 - ratio
    alpha_1 = 6.0 / (5.0 * w) - 2.0 / 3.0 + 4.0 * np.sqrt(3.0) / 135.0 * w**1.5
    alpha_2 = 12.0 / w - 8.0 / 3.0 + 8.0 * np.sqrt(3.0) / 189.0 * w**1.5 - 108.0 / (7.0 * w**2)
    np.testing.assert_allclose(celerity, alpha_1, atol=1e-12)
    np.testing.assert_allclose(velocity, alpha_2, atol=1e-12)


def test_dressler_misses_the_equations_by_the_second_order_of_the_friction():
    x = np.random.default_rng(7).uniform(-200.0, 150.0, 400)
    found = [residual(Dressler(10.0, n), x, 0.0 * x, 25.0) for n in (0.01, 0.01 / np.sqrt(2.0))]
    assert found[0] < 6e-3
    assert found[0] / found[1] == pytest.approx(4.0, rel=0.05)


def test_dressler_without_friction_is_ritter():
    x = np.linspace(-500.0, 700.0, 200)
    for smooth, dry in zip(
        Dressler(10.0, 0.0).state(x, 0.0 * x, 40.0), Ritter(10.0).state(x, 0.0 * x, 40.0), strict=True
    ):
        np.testing.assert_allclose(smooth, dry, atol=1e-9)


def kinematic_residual(plane, x, time, step=1e-3):
    """Largest residual of the kinematic wave in units of the rain."""

    def flow(x):
        return plane.alpha * plane.state(x, x, time)[0] ** (5.0 / 3.0)

    rate = (plane.state(x, x, time + step)[0] - plane.state(x, x, time - step)[0]) / (2.0 * step)
    gain = plane.excess if time < plane.rain_end else -plane.infiltration
    return np.abs(rate + (flow(x + step) - flow(x - step)) / (2.0 * step) - gain).max() / plane.rain


@pytest.mark.parametrize("plane", [PLANE, SOAKING], ids=["rain", "rain and infiltration"])
@pytest.mark.parametrize("time", [200.0, 1000.0, 1250.0, 1400.0])
def test_rain_on_a_plane_satisfies_the_kinematic_wave(plane, time):
    x = np.random.default_rng(7).uniform(20.0, 195.0, 200)
    x = x[plane.state(x, x, time)[0] > 1e-3]
    arrived = plane.alpha * plane.excess ** (2.0 / 3.0) * time ** (5.0 / 3.0)
    assert x.size > 20
    assert kinematic_residual(plane, x[np.abs(x - arrived) > 1.0], time) < 2e-5


def test_plane_gives_back_the_rain_that_fell_on_it():
    times = np.concatenate([np.linspace(0.0, 4000.0, 401), np.linspace(4050.0, 20000.0, 320)])
    left = np.trapezoid(PLANE.outflow(times), times)
    assert left == pytest.approx(PLANE.rain * PLANE.rain_end * PLANE.length, rel=2e-3)
    assert PLANE.concentration_time < PLANE.rain_end
    assert PLANE.outflow([1100.0])[0] == pytest.approx(PLANE.rain * PLANE.length, rel=1e-12)
    assert PLANE.kinematic_number > 500.0
