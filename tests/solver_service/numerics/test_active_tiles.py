"""Which tiles sleep, and that it changes nothing."""

import numpy as np

from solver_service.numerics import FloodModel
from solver_service.numerics.fields import TILE
from tests.solver_service.numerics.floods import bed, solver


def test_dry_land_far_from_the_water_sleeps():
    z = np.zeros((320, 320), np.float32)
    h = np.zeros_like(z)
    h[:20, :20] = 1.0
    s = solver(FloodModel(10.0, z, 0.03), threads=1)
    s.set_water(h)
    s.advance_to(5.0)
    assert s.active_cells <= 9 * TILE * TILE


def test_a_lake_at_rest_sleeps_but_still_limits_the_time_step():
    z = bed((64, 64))
    s = solver(FloodModel(10.0, z, 0.03), threads=1)
    s.set_water(np.maximum(np.float32(3.0) - z, 0.0))
    s.advance_to(200.0)
    assert s.active_cells == 0
    assert s.step_count >= 200.0 / s.dt


def test_a_wave_wakes_a_lake_at_rest_and_nothing_is_lost():
    z = bed((64, 200), roughness=0.2)
    h = np.maximum(np.float32(3.0) - z, 0.0)
    h[20:40, 2:10] += 1.0
    s = solver(FloodModel(10.0, z, 0.0), threads=1)
    s.set_water(h)
    s.advance_to(20.0)
    early = s.active_cells
    s.advance_to(250.0)
    assert early < s.active_cells
    assert abs(s.depth()[:, 150:] + z[:, 150:] - 3.0)[h[:, 150:] > 0.5].max() > 1e-3
    assert abs(s.budget().error_relative) < 1e-7


def test_sleep_changes_no_bit(monkeypatch):
    z = bed((64, 200), roughness=0.2)
    h = np.maximum(np.float32(3.0) - z, 0.0)
    h[:, 120:] = 0.0
    h[20:40, 2:10] += 1.0
    model = FloodModel(10.0, z, 0.02)
    states = []
    for awake in (False, True):
        s = solver(model, threads=1)
        if awake:
            s._tiles._forced.fill_(1)
        s.set_water(h)
        for time in (7.0, 30.0, 60.0):
            s.advance_to(time)
        if awake:
            assert s.active_cells >= z.size
        else:
            assert s.active_cells < z.size
        states.append((s.depth(), *s.velocity(), s.maxima().h, np.array([s.time, s.step_count])))
    assert all(np.array_equal(a, b) for a, b in zip(*states, strict=True))
