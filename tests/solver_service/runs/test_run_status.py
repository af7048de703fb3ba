import itertools

import pytest

from solver_service.errors import RunError
from solver_service.runs.run_status import ACTIVE, RULES, Move, RunStatus, check_move, moves_of


def test_every_move_has_its_rule_in_the_table() -> None:
    assert set(RULES) == set(Move)


@pytest.mark.parametrize(("status", "move"), list(itertools.product(RunStatus, Move)))
def test_a_move_is_refused_exactly_when_the_table_does_not_hold_it(status: RunStatus, move: Move) -> None:
    rule = RULES[move]
    if status in rule.sources:
        assert check_move("r1", status, move) is (rule.target or status)
    else:
        with pytest.raises(RunError, match=f"run r1 is {status.value} and cannot be {rule.verb}; it can"):
            check_move("r1", status, move)


def test_what_has_ended_never_changes_its_status() -> None:
    for status in (RunStatus.FINISHED, RunStatus.STOPPED):
        assert {RULES[move].target for move in Move if status in RULES[move].sources} == {None}


def test_a_run_that_computes_can_always_be_paused_stopped_or_fail_but_not_deleted() -> None:
    for status in ACTIVE:
        legal = {move for move in Move if status in RULES[move].sources}
        assert {Move.PAUSE, Move.STOP, Move.FAIL, Move.RESTART} <= legal
        assert Move.DELETE not in legal


def test_people_are_told_what_the_table_allows_now() -> None:
    assert moves_of(RunStatus.RUNNING, False) == ("pause", "stop", "pin")
    assert moves_of(RunStatus.PAUSED, False) == ("resume", "stop", "delete", "pin")
    assert moves_of(RunStatus.FAILED, True) == ("resume", "stop", "unpin")
    assert moves_of(RunStatus.FINISHED, False) == ("delete", "pin")
