"""The states of a run and the legal moves between them, in one table."""

from __future__ import annotations

from enum import StrEnum

from solver_service.errors import RunError


class RunStatus(StrEnum):
    """Where a run stands."""

    STARTING = "starting"
    RUNNING = "running"
    PAUSED = "paused"
    FINISHED = "finished"
    STOPPED = "stopped"
    FAILED = "failed"


LEGAL_MOVES: dict[RunStatus, frozenset[RunStatus]] = {
    RunStatus.STARTING: frozenset(
        {RunStatus.RUNNING, RunStatus.PAUSED, RunStatus.FINISHED, RunStatus.STOPPED, RunStatus.FAILED}
    ),
    RunStatus.RUNNING: frozenset({RunStatus.PAUSED, RunStatus.FINISHED, RunStatus.STOPPED, RunStatus.FAILED}),
    # paused -> finished: the last frame was on its way to the disk when the pause was asked for
    RunStatus.PAUSED: frozenset(
        {RunStatus.STARTING, RunStatus.FINISHED, RunStatus.STOPPED, RunStatus.FAILED}
    ),
    RunStatus.FINISHED: frozenset(),
    RunStatus.STOPPED: frozenset(),
    # failed -> starting: resumed from its last checkpoint
    RunStatus.FAILED: frozenset({RunStatus.STARTING, RunStatus.STOPPED}),
}
"""From a status to those it may become. A run that has ended is never changed; it can only be branched."""

ACTIVE = (RunStatus.STARTING, RunStatus.RUNNING)
"""Statuses in which a worker is bound to compute."""

_VERBS = {
    RunStatus.STARTING: "resumed",
    RunStatus.RUNNING: "run",
    RunStatus.PAUSED: "paused",
    RunStatus.FINISHED: "finished",
    RunStatus.STOPPED: "stopped",
    RunStatus.FAILED: "failed",
}


def check_move(run: str, status: RunStatus, wanted: RunStatus) -> None:
    """Refuse a move that the table does not hold.

    Raises:
        RunError: with the moves that are allowed.
    """
    if wanted not in LEGAL_MOVES[status]:
        raise RunError(f"run {run} is {status.value} and cannot be {_VERBS[wanted]}")
