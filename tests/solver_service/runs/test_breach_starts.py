import math

import pytest

from protocol import ForcingChange, ForcingItem
from solver_service.errors import RunError
from solver_service.runs.breach_starts import Start, check_breaches, start_under
from solver_service.runs.forced_course import Changes
from solver_service.scenario.forced_model import ForcedFrom

DAM = ForcingItem("dam", "breach", "s", start_time=300.0)
DIKE = ForcingItem("dike", "breach", "s", start_time=100.0, overtopping=True)
AS_THE_CASE = (ForcedFrom(0.0, ()),)


def at(start: float | str | None, breach: str = "dam") -> Changes:
    return (ForcingChange(breach, start_time=start),)  # type: ignore[arg-type]


def check(past: tuple[ForcedFrom, ...], changes: Changes, time: float) -> None:
    check_breaches((DAM, DIKE), past, changes, time)


def test_a_change_says_when_a_breach_begins_else_the_case_does() -> None:
    assert start_under(DAM, ()) == Start(300.0, False)
    assert start_under(DIKE, ()) == Start(100.0, True)
    assert start_under(DIKE, at(150.0, "dike")) == Start(150.0, False)
    assert start_under(DAM, at("never")) == Start(math.inf, False)
    assert [str(start_under(DIKE, change)) for change in ((), at("never", "dike"))] == [
        "when overtopped from 100 s on",
        "never",
    ]


@pytest.mark.parametrize("start", [120.0, 240.0, 900.0, "never", None])
def test_a_breach_that_has_not_begun_begins_now_or_later_or_never(start: float | str | None) -> None:
    check(AS_THE_CASE, at(start), 120.0)


def test_a_breach_does_not_begin_before_the_branch() -> None:
    with pytest.raises(RunError, match="'dam' would begin at 60 s, before the branch at 120 s"):
        check(AS_THE_CASE, at(60.0), 120.0)
    never = (ForcedFrom(0.0, at("never")),)
    with pytest.raises(RunError, match="would begin at 300 s, before the branch at 400 s"):
        check(never, (), 400.0)


@pytest.mark.parametrize("start", [300.5, 900.0, "never", 10.0])
def test_a_breach_that_has_begun_is_not_moved(start: float | str) -> None:
    for time in (300.0, 600.0):
        with pytest.raises(RunError, match=r"'dam' has begun at 300 s.*cannot be moved"):
            check(AS_THE_CASE, at(start), time)
        check(AS_THE_CASE, (), time)


def test_what_an_ancestor_began_stays_begun() -> None:
    past = (ForcedFrom(0.0, ()), ForcedFrom(50.0, at(80.0)), ForcedFrom(100.0, at(80.0)))
    check(past, at(80.0), 200.0)
    with pytest.raises(RunError, match="has begun at 80 s"):
        check(past, (), 200.0)


def test_what_an_ancestor_put_off_has_not_begun() -> None:
    past = (ForcedFrom(0.0, ()), ForcedFrom(250.0, at("never")))
    check(past, at(400.0), 350.0)


def test_a_breach_that_waits_for_the_water_may_be_moved_as_far_as_the_clock_tells() -> None:
    check(AS_THE_CASE, at(500.0, "dike"), 400.0)
    with pytest.raises(RunError, match="'dike' would begin at 200 s"):
        check(AS_THE_CASE, at(200.0, "dike"), 250.0)


def test_at_time_zero_nothing_has_begun() -> None:
    check((ForcedFrom(0.0, at(0.0)),), at(0.0), 0.0)
    check((ForcedFrom(0.0, at(0.0)),), at("never"), 0.0)
