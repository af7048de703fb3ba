"""A run that blows up says where, what and why, and goes on from the last state that was kept."""

import numpy as np
import pytest

from solver_service.numerics import FloodModel, SolverBlowUp, Source
from solver_service.numerics.blow_up import explain_blow_up
from solver_service.numerics.fields import FieldStore
from tests.solver_service.numerics.floods import differences, solver

BED = np.zeros((40, 50), np.float32)


def explained(model, **cells):
    """The error for a lake in which some cells hold other values."""
    store = FieldStore(*model.shape, "cpu")
    store.write("z", model.z_b)
    for name in "huv":
        values = np.full(model.shape, 1.0 if name == "h" else 0.0, np.float32)
        if name in cells:
            row, col, value = cells[name]
            values[row, col] = value
        store.write(name, values)
    return explain_blow_up(model, store, 12.5, 1e-4, 2.0)


@pytest.mark.parametrize(
    ("cells", "row", "col", "words"),
    [
        ({"u": (7, 9, np.nan)}, 7, 9, "u is nan m/s"),
        ({"v": (3, 4, -np.inf)}, 3, 4, "v is -inf m/s"),
        ({"h": (39, 49, -0.25)}, 39, 49, "h is -0.25 m"),
        ({"u": (5, 6, 2e5)}, 5, 6, r"wave speed 200003 m/s asks for dt < 0.0001 s"),
    ],
)
def test_time_cell_and_value_are_told(cells, row, col, words):
    error = explained(FloodModel(5.0, BED, 0.03), **cells)
    assert (error.time, error.row, error.col) == (12.5, row, col)
    with pytest.raises(SolverBlowUp, match=words):
        raise error
    assert str(error).count("\n") == 0


def test_the_likely_cause_is_looked_for_around_the_cell():
    cliff = BED.copy()
    cliff[:, 30:] = 42.0
    spring = Source([10, 10], [10, 11], [0.0, 9.0], [0.0, 5e6], id="spring")
    blocked = np.zeros(BED.shape, bool)
    blocked[30:, :] = True
    model = FloodModel(5.0, cliff, 0.03, sources=(spring,), blocked=blocked)
    assert (
        "spring near it, which brings up to 5e+06 m3/s into 2 cells" in explained(model, h=(12, 14, -1)).cause
    )
    assert "bed step of 42.0 m" in explained(model, h=(12, 33, -1)).cause
    assert "out of range" in explained(model, h=(25, 3, -1)).cause


@pytest.mark.parametrize("engine", ["rows", "kernels"])
def test_a_run_goes_on_from_the_state_before_it_blew_up(engine):
    whole, broken = (solver(FloodModel(5.0, BED, 0.02), engine=engine, threads=1) for _ in range(2))
    h = np.where(np.arange(50) < 20, 2.0, 0.5) * np.ones((40, 1))
    for s in (whole, broken):
        s.set_water(h)
        s.advance_to(4.0)
    kept = broken.snapshot()
    for name in ("u0", "u1"):
        broken._store.arrays[name].numpy()[22, 22] = np.nan
    with pytest.raises(SolverBlowUp):
        broken.advance_to(8.0)
    broken.restore(kept)
    for s in (whole, broken):
        s.advance_to(8.0)
    assert differences(whole, broken) == []


def test_a_source_that_brings_too_much_is_named():
    flood = Source([20], [20], [0.0, 1.0], [0.0, 1e12], id="burst")
    s = solver(FloodModel(5.0, BED, 0.03, sources=(flood,)), threads=1, dt_min=1e-3)
    with pytest.raises(SolverBlowUp, match="burst") as caught:
        s.advance_to(10.0)
    assert abs(caught.value.row - 20) <= 12
