"""The states of a run and everything that may happen to it in each of them, in one table."""

from __future__ import annotations

from dataclasses import dataclass
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


class Move(StrEnum):
    """What a person asks of a run (the first nine) or its worker makes of it."""

    PAUSE = "pause"
    RESUME = "resume"
    STOP = "stop"
    DELETE = "delete"
    RENAME = "rename"
    PIN = "pin"
    UNPIN = "unpin"
    EDIT = "edit"
    FORCE = "force"
    RECALCULATE = "recalculate"
    BEGIN = "begin"
    WAIT = "wait"
    FINISH = "finish"
    FAIL = "fail"
    RESTART = "restart"


@dataclass(frozen=True)
class Rule:
    """When a move is legal and where it leads.

    Attributes:
        verb: how a sentence says that it cannot be done.
        sources: statuses in which it is legal.
        target: the status afterwards; None leaves it as it is.
    """

    verb: str
    sources: frozenset[RunStatus]
    target: RunStatus | None


ACTIVE = (RunStatus.STARTING, RunStatus.RUNNING)
"""Statuses in which a worker is bound to compute."""

_ACTIVE = frozenset(ACTIVE)
_OPEN = _ACTIVE | {RunStatus.PAUSED}
_ALL = frozenset(RunStatus)

RULES: dict[Move, Rule] = {
    Move.PAUSE: Rule("paused", _ACTIVE, RunStatus.PAUSED),
    Move.RESUME: Rule("resumed", frozenset({RunStatus.PAUSED, RunStatus.FAILED}), RunStatus.STARTING),
    Move.STOP: Rule("stopped", _OPEN | {RunStatus.FAILED}, RunStatus.STOPPED),
    Move.DELETE: Rule("deleted", _ALL - _ACTIVE, None),
    Move.RENAME: Rule("renamed", _ALL, None),
    Move.PIN: Rule("pinned", _ALL, None),
    Move.UNPIN: Rule("unpinned", _ALL, None),
    Move.EDIT: Rule("edited", _ALL, None),
    Move.FORCE: Rule("given another forcing", _ALL, None),
    Move.RECALCULATE: Rule("recalculated", _ALL, None),
    Move.BEGIN: Rule("run", frozenset({RunStatus.STARTING}), RunStatus.RUNNING),
    Move.WAIT: Rule("paused", _ACTIVE, RunStatus.PAUSED),
    # also from paused: the last frame was on its way to the disk when the pause was asked for
    Move.FINISH: Rule("finished", _OPEN, RunStatus.FINISHED),
    Move.FAIL: Rule("failed", _OPEN, RunStatus.FAILED),
    # its worker died and another one takes over
    Move.RESTART: Rule("restarted", _ACTIVE, RunStatus.STARTING),
}
"""Every move. Nothing leads out of finished and stopped: such a run can only be branched, or deleted."""


def check_move(run: str, status: RunStatus, move: Move) -> RunStatus:
    """The status after a move.

    Raises:
        RunError: the table does not hold it; with the statuses in which it is allowed.
    """
    rule = RULES[move]
    if status not in rule.sources:
        allowed = ", ".join(each.value for each in RunStatus if each in rule.sources)
        raise RunError(f"run {run} is {status.value} and cannot be {rule.verb}; it can while it is {allowed}")
    return status if rule.target is None else rule.target


STEERED = (Move.PAUSE, Move.RESUME, Move.STOP, Move.DELETE, Move.PIN, Move.UNPIN)
"""Moves that people make by buttons."""


def moves_of(status: RunStatus, pinned: bool) -> tuple[str, ...]:
    """The moves that a person may make now, by the table; pinned runs are not deleted.

    Args:
        status: of the run.
        pinned: whether it is pinned.
    """
    barred = {Move.PIN, Move.DELETE} if pinned else {Move.UNPIN}
    return tuple(move.value for move in STEERED if status in RULES[move].sources and move not in barred)
