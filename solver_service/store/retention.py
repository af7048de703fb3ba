"""What goes first when the store needs room, as a plan without a disk.

In this order, each for the oldest run first: the middle checkpoints of runs that have ended, then their
other checkpoints (a branch of such a run is then computed from farther back, to the same bits), then whole
runs that have ended. Nothing goes of a run that is pinned, that has not ended, or whose past a run that stays
needs.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from solver_service.store.records import CheckpointRecord


@dataclass(frozen=True)
class StoredRun:
    """What the plan knows of a run.

    Attributes:
        run: its id.
        parent: the run it branched from.
        has_ended: whether it is finished or stopped.
        pinned: whether it is kept in any case.
        frame_bytes: size of its frames [bytes].
        checkpoints: its checkpoints, earliest first.
    """

    run: str
    parent: str | None
    has_ended: bool
    pinned: bool
    frame_bytes: int
    checkpoints: tuple[CheckpointRecord, ...] = ()

    @property
    def may_go(self) -> bool:
        """Whether anything of it may go at all."""
        return self.has_ended and not self.pinned


@dataclass(frozen=True)
class Removal:
    """One step of the plan.

    Attributes:
        run: the run.
        checkpoint: the checkpoint that goes, or None for the whole run.
        size: what it frees [bytes].
    """

    run: str
    checkpoint: CheckpointRecord | None
    size: int


def plan_removals(runs: Iterable[StoredRun], lack: int) -> list[Removal]:
    """What to remove so that so much is freed, or all that may go where that is not enough.

    Args:
        runs: all runs in the order in which they were made.
        lack: bytes to free.
    """
    plan: list[Removal] = []
    for removal in _candidates(list(runs)):
        if lack <= 0:
            break
        plan.append(removal)
        lack -= removal.size
    return plan


def _candidates(runs: list[StoredRun]) -> Iterator[Removal]:
    gone: dict[str, int] = {run.run: 0 for run in runs}
    loose = [run for run in runs if run.may_go]
    for part in (slice(1, -1), None):
        for run in loose:
            ends = run.checkpoints if len(run.checkpoints) < 2 else (run.checkpoints[0], run.checkpoints[-1])
            for checkpoint in run.checkpoints[part] if part is not None else ends:
                gone[run.run] += checkpoint.size
                yield Removal(run.run, checkpoint, checkpoint.size)
    left = {run.run: run for run in runs}
    while True:
        parents = {run.parent for run in left.values()}
        leaf = next((run for run in left.values() if run.may_go and run.run not in parents), None)
        if leaf is None:
            return
        del left[leaf.run]
        size = leaf.frame_bytes + sum(each.size for each in leaf.checkpoints) - gone[leaf.run]
        yield Removal(leaf.run, None, size)
