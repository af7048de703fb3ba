"""The volume budget: what it adds up and how it is shown."""

import json

import pytest

from solver_service.numerics import VolumeBudget
from solver_service.numerics.budget import close_budget
from solver_service.numerics.step_part import PartVolumes

BOOKED = close_budget(
    initial=100.0,
    stored=117.0,
    edits=2.0,
    parts=(
        PartVolumes(edges={"west-1": (30.0, 4.0), "tide": (0.0, 6.0)}),
        PartVolumes(structures={"pump": 5.0}, moved={"culvert": 7.0}, edits=1.0),
        PartVolumes(rain=8.0, sources={"a": 10.0, "b": 1.0}),
        PartVolumes(infiltration=13.0),
    ),
)


def test_every_part_is_added_and_the_rest_is_the_error():
    assert BOOKED.inflow == 41.0
    assert BOOKED.outflow == 15.0
    assert BOOKED.edits == 3.0
    assert BOOKED.error == pytest.approx(117.0 - (100.0 + 41.0 + 8.0 - 13.0 - 15.0 - 3.0))
    assert BOOKED.error_relative == pytest.approx(BOOKED.error / 149.0)


def test_what_is_moved_within_the_domain_is_not_in_the_balance():
    assert VolumeBudget(1.0, 1.0, moved={"culvert": 9.0}).error == 0.0


def test_a_structure_that_brings_water_counts_as_inflow():
    budget = VolumeBudget(1.0, 3.0, structures={"pump": -2.0})
    assert (budget.inflow, budget.outflow, budget.error) == (2.0, 0.0, 0.0)


def test_no_water_at_all_has_no_error():
    assert VolumeBudget(0.0, 0.0).error_relative == 0.0


def test_the_budget_is_shown_as_plain_numbers_by_name():
    shown = json.loads(json.dumps(BOOKED.as_dict()))
    assert shown["edges"]["tide"] == {"in": 0.0, "out": 6.0}
    assert shown["sources"] == {"a": 10.0, "b": 1.0}
    assert shown["error"] == BOOKED.error
