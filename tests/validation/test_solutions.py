"""The exact solutions judge the solver, so they are judged first: they must satisfy the shallow-water
equations."""

import numpy as np
import pytest

from tests.validation.equations import residual
from tests.validation.solutions import (
    Ritter,
    SimpleWave,
    StationaryVortex,
    Stoker,
    ThackerPlanar,
    ThackerRadial,
    WallReflection,
)

PLANAR = ThackerPlanar(a=1000.0, h0=10.0, sigma=400.0)
RADIAL = ThackerRadial(a=1000.0, h0=10.0, r0=800.0)
WAVE = SimpleWave(h0=10.0, rise=0.05, width=200.0)
VORTEX = StationaryVortex(h0=10.0, peak=3.0, radius=200.0)


@pytest.mark.parametrize(
    ("solution", "reach", "time"),
    [
        (PLANAR, 400.0, 0.37 * PLANAR.period),
        (RADIAL, 600.0, 0.37 * RADIAL.period),
        (WAVE, 600.0, 0.5 * WAVE.breaking_time()),
        (VORTEX, 600.0, 5.0),
        (Ritter(10.0), 200.0, 25.0),
        (Ritter(10.0, angle=0.5), 100.0, 25.0),
        (ThackerPlanar(1000.0, 10.0, 400.0, phase=0.8), 400.0, 100.0),
        (Stoker(10.0, 1.0), 150.0, 25.0),
        (Stoker(10.0, 1.0, angle=0.7), 100.0, 25.0),
    ],
    ids=lambda value: type(value).__name__ if not isinstance(value, float) else "",
)
def test_exact_solution_satisfies_the_shallow_water_equations_where_it_is_smooth(solution, reach, time):
    x, y = np.random.default_rng(7).uniform(-reach, reach, (2, 400))
    assert residual(solution, x, y, time) < 2e-6


def test_a_wrong_solution_has_a_residual_that_shows_it():
    class TooFast(ThackerRadial):
        @property
        def omega(self):
            return 1.01 * super().omega

    x, y = np.random.default_rng(7).uniform(-600.0, 600.0, (2, 400))
    assert residual(TooFast(a=1000.0, h0=10.0, r0=800.0), x, y, 60.0) > 1e-3


@pytest.mark.parametrize("solution", [PLANAR, RADIAL], ids=["planar", "radial"])
@pytest.mark.parametrize("fraction", [0.0, 0.2, 0.5, 0.9])
def test_thacker_basins_keep_their_volume(solution, fraction):
    dx = 5.0
    line = np.arange(-1600.0 + dx / 2, 1600.0, dx)
    x, y = np.meshgrid(line, line)
    h = solution.state(x, y, fraction * solution.period)[0]
    assert h.sum() * dx * dx == pytest.approx(solution.volume(), rel=2e-5)


def test_thacker_basins_return_after_a_period_and_swing_between():
    x, y = np.random.default_rng(3).uniform(-900.0, 900.0, (2, 300))
    for solution in (PLANAR, RADIAL):
        start, later, half = (np.array(solution.state(x, y, k * solution.period))[0] for k in (0.0, 3.0, 0.5))
        np.testing.assert_allclose(start, later, atol=1e-9)
        assert np.abs(start - half).max() > 1.0


def test_radial_basin_is_dry_outside_its_shore_and_wet_inside():
    angle = np.linspace(0.0, 2.0 * np.pi, 50)
    for time in (0.0, 0.3 * RADIAL.period, 0.5 * RADIAL.period):
        for radius, wet in ((RADIAL.shore(time) - 0.1, True), (RADIAL.shore(time) + 0.1, False)):
            h = RADIAL.state(radius * np.cos(angle), radius * np.sin(angle), time)[0]
            assert np.all((h > 0.0) == wet)
    assert RADIAL.shore(0.0) == pytest.approx(np.sqrt(RADIAL.a * RADIAL.r0))


def test_ritter_and_stoker_keep_the_water_that_stood_behind_the_dam():
    x = np.arange(-999.5, 1000.0, 1.0)
    for solution, before in ((Ritter(10.0), 0.0), (Stoker(10.0, 1.0), 1.0)):
        h = solution.state(x, np.zeros(x.size), 30.0)[0]
        assert h.sum() == pytest.approx(1000.0 * (10.0 + before), rel=2e-4)


def test_stoker_bore_keeps_mass_and_momentum():
    dam = Stoker(10.0, 1.0)
    h, u, bore = dam.plateau
    assert (h - 1.0) * bore == pytest.approx(h * u, rel=1e-12)
    assert h * u * bore == pytest.approx(h * u * u + 0.5 * 9.81 * (h * h - 1.0), rel=1e-10)


def test_reflected_bore_keeps_mass_and_momentum():
    wall = WallReflection(depth=2.0, speed=5.0)
    h2, back = wall.reflected
    assert (h2 - 2.0) * back == pytest.approx(2.0 * 5.0, rel=1e-12)
    assert 2.0 * 5.0 * (5.0 + back) == pytest.approx(0.5 * 9.81 * (h2 * h2 - 4.0), rel=1e-10)


def test_stoker_on_a_vanishing_film_becomes_ritter_behind_the_bore():
    x = np.linspace(-250.0, 300.0, 200)
    wet, dry = (solution.state(x, 0.0 * x, 25.0)[0] for solution in (Stoker(10.0, 1e-9), Ritter(10.0)))
    np.testing.assert_allclose(wet, dry, atol=1e-9)


def test_simple_wave_steepens_but_stays_continuous_before_it_breaks():
    x = np.linspace(-800.0, 2400.0, 6401)
    h = WAVE.state(x, 0.0 * x, 0.9 * WAVE.breaking_time())[0]
    start = WAVE.state(x, 0.0 * x, 0.0)[0]
    assert np.abs(np.diff(h)).max() > 3.0 * np.abs(np.diff(start)).max()
    assert np.abs(np.diff(h)).max() < 0.1
