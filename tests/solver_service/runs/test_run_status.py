import itertools

import pytest

from solver_service.errors import RunError
from solver_service.runs.run_status import ACTIVE, LEGAL_MOVES, RunStatus, check_move


def test_every_status_has_its_moves_in_the_table() -> None:
    assert set(LEGAL_MOVES) == set(RunStatus)


@pytest.mark.parametrize(("status", "wanted"), list(itertools.product(RunStatus, RunStatus)))
def test_a_move_is_refused_exactly_when_the_table_does_not_hold_it(
    status: RunStatus, wanted: RunStatus
) -> None:
    if wanted in LEGAL_MOVES[status]:
        check_move("r1", status, wanted)
    else:
        with pytest.raises(RunError, match=f"run r1 is {status.value} and cannot be "):
            check_move("r1", status, wanted)


def test_what_has_ended_never_changes() -> None:
    assert not LEGAL_MOVES[RunStatus.FINISHED]
    assert not LEGAL_MOVES[RunStatus.STOPPED]


def test_a_run_that_computes_can_always_be_paused_stopped_or_fail() -> None:
    for status in ACTIVE:
        assert {RunStatus.PAUSED, RunStatus.STOPPED, RunStatus.FAILED} <= LEGAL_MOVES[status]
