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


def test_a_state_is_adopted_by_a_model_with_rain_that_it_did_not_have():
    dry = solver(full_model(rain=False), threads=1)
    dry.set_water(*wild_water(MODEL.z_b))
    dry.advance_to(2.0)
    s = solver(MODEL, threads=1)
    s.adopt(dry.snapshot())
    before, after = dry.budget(), s.budget()
    assert (after.rain, after.stored, after.inflow) == (0.0, before.stored, before.inflow)
    assert differences(dry, s) == []
    s.advance_to(4.0)
    assert s.budget().rain > 0.0
