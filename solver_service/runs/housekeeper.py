"""Keeps the store within its room: removes what may go, else pauses the runs until there is room again."""

from __future__ import annotations

import asyncio
import logging
import time
from collections import Counter
from dataclasses import dataclass, field
from typing import Protocol

from solver_service.errors import ServiceError
from solver_service.runs.run_reports import RunReports
from solver_service.runs.run_status import ACTIVE, RunStatus
from solver_service.runs.run_tree import Run, RunTree
from solver_service.runs.store_thread import StoreThread
from solver_service.store import (
    DataFolder,
    FrameRecord,
    Removal,
    RunDatabase,
    StoredRun,
    compact_run,
    free_bytes,
    has_room,
    is_scattered,
    plan_removals,
    remove_checkpoint,
)

LOG = logging.getLogger(__name__)

ENDED = (RunStatus.FINISHED, RunStatus.STOPPED)
PROBE_BYTES = 4 << 20
HEADROOM = 0.02
"""Share of the budget that must be free before runs that waited for room go on."""
LONGEST_DELAY_S = 60.0


@dataclass(frozen=True)
class RoomRules:
    """How much the store may take.

    Attributes:
        store_bytes: most bytes of frames and checkpoints; None for as much as the disk has.
        reserve_bytes: room on the disk that is left to others [bytes].
        interval_s: time between two looks [s].
    """

    store_bytes: int | None = None
    reserve_bytes: int = 256 << 20
    interval_s: float = 2.0


class RunCommands(Protocol):
    """What the housekeeper asks of the control of runs."""

    def halt(self, run: Run, reason: str) -> None:
        """Let a run wait and tell why."""

    async def resume(self, name: str) -> None:
        """Go on with a run."""

    async def delete(self, name: str) -> None:
        """Forget a run."""


@dataclass
class _Patience:
    """When a run that waits for room is tried again."""

    at: float = 0.0
    delay_s: float = 0.0


@dataclass
class Housekeeper:
    """Looks after the room at intervals, on the event loop.

    Attributes:
        commands: resumes and deletes runs.
        tree: the runs.
        store: the store's thread.
        folder: the data folder.
        reports: moves runs and tells people.
        rules: how much room there is.
        epoch: epoch of the service.
    """

    commands: RunCommands
    tree: RunTree
    store: StoreThread
    folder: DataFolder
    reports: RunReports
    rules: RoomRules
    epoch: int
    _waits: dict[str, _Patience] = field(default_factory=dict)
    _compacted: set[str] = field(default_factory=set)

    async def work(self) -> None:
        """Look again and again, until cancelled."""
        while True:
            await asyncio.sleep(self.rules.interval_s)
            try:
                await self.look()
            except ServiceError as error:
                LOG.warning("housekeeping: %s", error)

    async def look(self) -> None:
        """Look once.

        Raises:
            ServiceError: something could not be done; it is tried again at the next look.
        """
        lack = await self._lack()
        if lack > 0:
            lack -= await self._make_room(lack)
        if lack > 0:
            self._pause_all(lack)
            return
        await self._resume_waiting()
        await self._compact_one()

    async def _lack(self) -> int:
        """Bytes that are too many; below 0 for room that is left."""
        free = await asyncio.to_thread(free_bytes, self.folder)
        lack = self.rules.reserve_bytes - free
        if self.rules.store_bytes is not None:
            stored = await self.store.call(RunDatabase.stored_bytes)
            lack = max(lack, sum(each.size for each in stored) - self.rules.store_bytes)
        return lack

    async def _make_room(self, lack: int) -> int:
        """Remove what may go, in the order of the plan; gives what was freed [bytes]."""
        sizes: Counter[str] = Counter()
        for each in await self.store.call(RunDatabase.stored_bytes):
            sizes[each.run] += each.size if each.kind != "checkpoints" else 0
        runs = []
        for run in self.tree:
            checkpoints = await self.store.call(RunDatabase.checkpoints, run.run)
            ended = run.status in ENDED
            runs.append(
                StoredRun(
                    run.run,
                    run.record.parent,
                    ended,
                    run.record.pinned,
                    sizes[run.run],
                    tuple(checkpoints),
                )
            )
        freed = 0
        for removal in plan_removals(runs, lack):
            await self._remove(removal)
            freed += removal.size
        return freed

    async def _remove(self, removal: Removal) -> None:
        if removal.checkpoint is not None:
            await self.store.call(remove_checkpoint, self.folder, removal.checkpoint)
            return
        await self.commands.delete(removal.run)
        self.reports.notice(
            "warning", f"run {removal.run} was deleted: the store had no room left", removal.run
        )

    def _pause_all(self, lack: int) -> None:
        reason = (
            f"there is no room in {self.folder.root}: {lack / 1e6:.1f} MB must go and nothing more may; "
            "delete or unpin runs, or allow more"
        )
        for run in self.tree:
            if run.status in ACTIVE:
                self.commands.halt(run, reason)
                run.lacks_room = True

    async def _resume_waiting(self) -> None:
        waiting = [run for run in self.tree if run.lacks_room and run.status is RunStatus.PAUSED]
        if not waiting:
            self._waits.clear()
            return
        headroom = int(HEADROOM * (self.rules.store_bytes or 0))
        if await self._lack() > -headroom or not await asyncio.to_thread(has_room, self.folder, PROBE_BYTES):
            return
        for run in waiting:
            patience = self._waits.setdefault(run.run, _Patience(delay_s=self.rules.interval_s))
            if time.monotonic() >= patience.at:
                patience.delay_s = min(2.0 * patience.delay_s, LONGEST_DELAY_S)
                patience.at = time.monotonic() + patience.delay_s
                await self.commands.resume(run.run)

    async def _compact_one(self) -> None:
        """Move the frames of one run that has ended together."""
        for run in self.tree:
            if run.status not in ENDED or run.run in self._compacted or _is_held(run):
                continue
            self._compacted.add(run.run)
            if is_scattered([*run.frames, *await self.store.call(RunDatabase.channels, run.run)]):
                async with run.lock:
                    run.frames = await asyncio.to_thread(self._compacted_frames, run.run)
                LOG.info("frames moved together", extra={"run": run.run})
                return

    def _compacted_frames(self, run: str) -> list[FrameRecord]:
        database = RunDatabase(self.folder.database, self.epoch)
        try:
            return compact_run(self.folder, database, run)
        finally:
            database.close()


def _is_held(run: Run) -> bool:
    """Whether something of a run may still be on its way to the disk."""
    return run.worker is not None and run.run in run.worker.holds
