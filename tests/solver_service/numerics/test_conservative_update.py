"""Thin films never shorten the time step, and what is not a number is never hidden."""

import numpy as np
import pytest
import warp as wp

from solver_service.numerics import FloodModel
from solver_service.numerics.conservative_update import film_speed, limited
from tests.solver_service.numerics.floods import differences, solver


def film_on_a_cliff(**params):
    """Four millimetres of water that nothing slows down, on a cliff of 100 m above a shallow pool."""
    z = np.zeros((24, 60), np.float32)
    z[:, 36:40], z[:, 40:] = (20.0, 40.0, 60.0, 80.0), 100.0
    h = np.where(np.arange(60) < 36, 0.3, 4e-3) * np.ones((24, 1))
    s = solver(FloodModel(2.0, z, 0.0), **{"threads": 1, **params})
    s.set_water(h)
    return s


def shortest_step(s, until):
    """Shortest step that stability asks for [s], looked at ten times a second."""
    shortest = np.inf
    for time in np.arange(0.1, until, 0.1):
        s.advance_to(float(time))
        shortest = min(shortest, s.dt)
    return shortest


def test_a_film_that_falls_from_a_cliff_does_not_shorten_the_step():
    freely, held = film_on_a_cliff(depth_cfl=0.0), film_on_a_cliff()
    waves_of_the_pool = 0.45 * 2.0 / (2.0 * np.sqrt(9.81 * 0.3))
    assert shortest_step(held, 12.0) > 0.7 * waves_of_the_pool
    assert shortest_step(freely, 12.0) < 0.25 * waves_of_the_pool
    assert abs(held.budget().error_relative) < 1e-9
    assert held.depth().min() >= 0.0


def test_films_are_held_alike_by_both_engines():
    oracle, rows = (film_on_a_cliff(engine=engine) for engine in ("kernels", "rows"))
    for s in (oracle, rows):
        s.advance_to(6.0)
    assert differences(oracle, rows) == []


def test_films_that_water_drives_are_as_fast_as_the_water():
    s = solver(FloodModel(5.0, np.zeros((8, 120), np.float32), 0.0), threads=1)
    s.set_water(np.where(np.arange(120) < 40, 2.0, 0.0) * np.ones((8, 1)))
    ratios = []
    for time in np.arange(5.0, 20.0, 1.0):
        s.advance_to(float(time))
        u, h = s.velocity()[0][4], s.depth()[4]
        film = (h > 1e-3) & (h < 5e-3)
        ratios += (u[film] / u[h >= 5e-3].max()).tolist()
    assert len(ratios) > 3
    assert 0.7 < max(ratios) <= 1.1


@wp.kernel
def evaluate(x: wp.array(dtype=wp.float32), most: float, out: wp.array(dtype=wp.float32)):
    k = wp.tid()
    out[k] = limited(x[k], most)
    if k == 0:
        out[0] = film_speed(0.9, 5.0e-3, 0.1)


def test_a_limit_keeps_what_is_not_a_number():
    x = wp.array([0.0, np.nan, np.inf, -np.inf, 3.0, -3.0, 0.5], dtype=wp.float32, device="cpu")
    out = wp.zeros_like(x)
    wp.launch(evaluate, dim=7, inputs=[x, 2.0], outputs=[out], device="cpu")
    np.testing.assert_array_equal(out.numpy()[1:], np.float32([np.nan, 2.0, -2.0, 2.0, -2.0, 0.5]))
    assert out.numpy()[0] == pytest.approx(9.0 - np.sqrt(9.81 * 5e-3), rel=1e-6)
