"""A state that is kept and put back is the same state, with everything that parts of the step remember."""

import pytest

from solver_service.numerics import ModelError, ShallowWaterSolver, SolverParams
from tests.solver_service.numerics.floods import differences, full_model, solver, wild_water

MODEL = full_model()


def test_a_run_goes_on_from_a_snapshot_bit_for_bit():
    whole, first, second = (solver(MODEL, threads=2) for _ in range(3))
    for s in (whole, first):
        s.set_water(*wild_water(MODEL.z_b))
        s.advance_to(3.0)
    second.restore(first.snapshot())
    for s in (whole, second):
        s.advance_to(7.0)
    assert differences(whole, second) == []


def test_a_snapshot_of_a_model_without_the_part_is_refused_and_changes_nothing():
    bare = ShallowWaterSolver(full_model(rain=False), SolverParams(threads=1))
    bare.set_water(*wild_water(MODEL.z_b))
    s = solver(MODEL, threads=1)
    with pytest.raises(ModelError, match=r"snapshot.s released has the shape \(1,\)"):
        s.restore(bare.snapshot())
    assert not s.depth().any()
