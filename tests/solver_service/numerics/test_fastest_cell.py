"""The cell whose wave decides the time step."""

import numpy as np
import pytest

from solver_service.numerics.fastest_cell import FastestCell, fastest_cell
from solver_service.numerics.fields import FieldStore

SHAPE = (37, 150)


def store_with(h, u, v):
    store = FieldStore(*SHAPE, "cpu")
    for name, values in (("h", h), ("u", u), ("v", v)):
        store.write(name, values)
    return store


def random_state(seed=0):
    rng = np.random.default_rng(seed)
    h = (rng.random(SHAPE) * (rng.random(SHAPE) < 0.5)).astype(np.float32)
    u, v = rng.normal(0.0, 2.0, (2, *SHAPE)).astype(np.float32)
    return h, u, v


def test_it_is_the_one_that_a_look_at_every_cell_finds():
    h, u, v = random_state()
    waves = np.maximum(abs(u), abs(v)) + np.sqrt(np.float32(9.81) * h)
    row, col = divmod(int(waves.argmax()), SHAPE[1])
    assert fastest_cell(store_with(h, u, v)) == FastestCell(float(waves.max()), row, col)


def test_the_first_of_equals_is_taken():
    still = np.zeros(SHAPE, np.float32)
    u = still.copy()
    u[3, 140], u[5, 2], u[36, 149] = -7.0, 7.0, 7.0
    assert fastest_cell(store_with(still, u, still)) == FastestCell(7.0, 3, 140)
    assert fastest_cell(store_with(still, still, still)) == FastestCell(0.0, 0, 0)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("name", ["h", "u", "v"])
def test_a_state_that_is_not_finite_counts_as_the_fastest(name, bad):
    state = dict(zip("huv", random_state(), strict=True))
    state[name][20, 77] = bad
    found = fastest_cell(store_with(**state))
    assert (found.row, found.col) == (20, 77)
    assert found.wave > 1e38


def test_a_negative_depth_counts_as_the_fastest():
    h, u, v = random_state()
    h[9, 9] = -1e-3
    assert fastest_cell(store_with(h, u, v)).wave > 1e38
