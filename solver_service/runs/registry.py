"""The runs of a service: every command of a viewer or a script ends here.

Lives on one event loop. What a command acknowledges is in the store before the call returns.
"""

from __future__ import annotations

import asyncio
import logging
import secrets
from collections.abc import Coroutine
from dataclasses import replace
from pathlib import Path
from typing import Any

from protocol import CaseSummary, RunBranched, RunChanged, RunInfo, RunRemoved
from solver_service.errors import RunError, StoreError
from solver_service.runs.audience import Audience
from solver_service.runs.case_catalogue import CaseCatalogue
from solver_service.runs.controllers import Controllers
from solver_service.runs.edit_blobs import pack_edits
from solver_service.runs.edit_desk import EditDesk
from solver_service.runs.housekeeper import Housekeeper, RoomRules
from solver_service.runs.restart_policy import RestartPolicy
from solver_service.runs.run_reports import RunReports
from solver_service.runs.run_status import ACTIVE, Move, RunStatus, check_move
from solver_service.runs.run_tree import Run, RunTree
from solver_service.runs.store_thread import StoreThread
from solver_service.runs.supervisor import Supervisor, load_run
from solver_service.runs.worker import Worker
from solver_service.runs.worker_messages import Pause, WorkerSettings
from solver_service.runs.worker_pool import WorkerPool
from solver_service.store import (
    DataFolder,
    FrameReader,
    FrameRecord,
    RunDatabase,
    RunRecord,
    load_bed,
    remove_run_files,
)

INTERRUPTED = "the service ended while it was computed; resume goes on from the last checkpoint"
LOG = logging.getLogger(__name__)

SAVE_TIMEOUT_S = 10.0
CLOSE_TIMEOUT_S = 1.0


class RunRegistry:
    """Runs, their workers and their store.

    Attributes:
        audience: who is told of changes.
        tree: all runs.
        edits: their working lists.
        controllers: who may change them.
        supervisor: their workers.
    """

    def __init__(
        self,
        data_dir: Path,
        cases: tuple[str, ...] = (),
        device: str = "auto",
        threads: int | None = None,
        ring_bytes: int = 1 << 30,
        checkpoint_interval_s: float = 60.0,
        spare_workers: int = 1,
        restart_attempts: int = 3,
        restart_within_s: float = 600.0,
        room: RoomRules | None = None,
    ) -> None:
        """Open the store; `open` then begins the work.

        Args:
            data_dir: the data folder.
            cases: cases offered beside the known ones.
            device: device of runs that ask for "auto".
            threads: solver threads on the CPU.
            ring_bytes: memory of a worker for recent states [bytes].
            checkpoint_interval_s: wall time between checkpoints [s].
            spare_workers: warm workers that stand by.
            restart_attempts: how often a run whose worker died is taken up again by itself.
            restart_within_s: the time in which these attempts count [s].
            room: how much the store may take.

        Raises:
            StoreError: the folder is in use or cannot be used.
            CaseError: an offered case cannot be read.
        """
        self._device = device
        self._catalogue = CaseCatalogue(cases)
        self._folder = DataFolder(data_dir)
        self._folder.lock()
        self._store = StoreThread(self._folder)
        self._reader = FrameReader(self._folder)
        self._worker_settings = WorkerSettings(
            data_dir, 0, ring_bytes, checkpoint_interval_s, threads, device
        )
        self._spare_workers = spare_workers
        self._room = room or RoomRules()
        self._housekeeping: asyncio.Task[None]
        self._commands: set[asyncio.Task[None]] = set()
        self.audience = Audience()
        self.tree = RunTree()
        self.reports = RunReports(self.tree, self._store, self.audience)
        self.controllers = Controllers(self.audience.announce)
        self.edits = EditDesk(self.tree, self._store, self.audience)
        policy = RestartPolicy(restart_attempts, restart_within_s)
        self.supervisor = Supervisor(
            self.tree, self._store, self._folder, self._catalogue, self.reports, policy
        )

    async def open(self) -> None:
        """Take over the store: fence off earlier services, mend what a crash left, warm a worker."""
        epoch = await self._store.call(RunDatabase.begin_epoch)
        self._folder.remove_unfinished()
        active = tuple(status.value for status in ACTIVE)
        await self._store.call(RunDatabase.interrupt_active, active, RunStatus.PAUSED.value, INTERRUPTED)
        for record in await self._store.call(RunDatabase.runs):
            self.tree.add(await self._store.call(load_run, self._folder, record))
        keeper = Housekeeper(self, self.tree, self._store, self._folder, self.reports, self._room, epoch)
        self._housekeeping = asyncio.get_running_loop().create_task(keeper.work())
        self.supervisor.pool = WorkerPool(
            replace(self._worker_settings, epoch=epoch),
            self._spare_workers,
            self.supervisor.hear,
            self.supervisor.lost,
            lambda name: name in self.tree and self.tree.get(name).status not in ACTIVE,
        )
        self.pool.start_spares()

    async def close(self) -> None:
        """Pause what computes, end the workers, close the store."""
        self._housekeeping.cancel()
        computing = [run for run in self.tree if run.status in ACTIVE]
        await self.supervisor.close()
        if self._commands:
            await asyncio.wait(self._commands, timeout=CLOSE_TIMEOUT_S)
        for run in computing:
            if run.status in ACTIVE:
                self.reports.move(run, Move.PAUSE, "the service was ended; resume goes on from here")
        self._store.close()
        self._folder.unlock()

    async def carry_through(self, command: Coroutine[Any, Any, None]) -> None:
        """Carry a command to its end, also when whoever waits for it is cancelled."""
        task = asyncio.get_running_loop().create_task(command)
        self._commands.add(task)
        task.add_done_callback(self._command_done)
        await asyncio.shield(task)

    def _command_done(self, task: asyncio.Task[None]) -> None:
        self._commands.discard(task)
        if not task.cancelled() and (error := task.exception()) is not None:
            LOG.debug("a command was refused: %s", error)  # whoever still waits for it is told

    # what there is

    @property
    def cases(self) -> tuple[CaseSummary, ...]:
        """The cases on offer."""
        return self._catalogue.summaries

    def infos(self) -> tuple[RunInfo, ...]:
        """All runs, newest first."""
        return tuple(self.tree.info(run) for run in reversed(list(self.tree)))

    @property
    def pool(self) -> WorkerPool:
        """The worker processes."""
        return self.supervisor.pool

    async def read_frame(self, record: FrameRecord) -> bytes:
        """The packed bytes of a frame, read away from the event loop.

        Raises:
            StoreError: they are missing or damaged.
        """
        try:
            return await asyncio.to_thread(self._reader.read, record)
        except StoreError:  # it may have moved to another segment since the row was read
            row = await self._store.call(RunDatabase.frame, record.run, record.index)
            if row is None or row == record:
                raise
            return await asyncio.to_thread(self._reader.read, row)

    async def read_bed(self, name: str) -> bytes:
        """The packed base bed of a run."""
        return await asyncio.to_thread(load_bed, self._folder, self.tree.get(name).record.case_fingerprint)

    # run control

    async def start_run(
        self,
        case: str,
        duration: float | None = None,
        output_interval: float | None = None,
        device: str = "auto",
        paused: bool = False,
    ) -> Run:
        """Start a run of a case from time 0.

        Raises:
            RunError: the case is not offered, cannot be loaded, or no worker is free.
            StoreError: the run cannot be stored.
        """
        case = self._catalogue.name(case)
        source = self._catalogue.source(case)
        device = self._device if device == "auto" else device
        name = _new_id()
        worker = await self.pool.take(name, source, device)
        try:
            loaded = await worker.load(source, device)
            record = RunRecord(
                run=name,
                case=case,
                case_fingerprint=loaded.fingerprint,
                title=loaded.title,
                parent=None,
                branch_index=0,
                status=RunStatus.STARTING.value,
                status_reason="",
                duration=duration or loaded.duration,
                output_interval=output_interval or loaded.output_interval,
                device=loaded.device,
                bed_revision=0,
                bed_edits=pack_edits(()),
                facts=loaded.facts.pack(),
            )
            await self._store.call(RunDatabase.insert_run, record)
        except BaseException:
            self.pool.release(worker)
            raise
        run = Run.of(record, ())
        self.tree.add(run)
        self.supervisor.begin(run, worker, paused=paused)
        self.audience.announce(RunChanged(self.tree.info(run)))
        return run

    async def pause(self, name: str) -> None:
        """Stop computing a run until `resume`."""
        run = self.tree.get(name)
        async with run.lock:
            self.reports.move(run, Move.PAUSE)
            if run.worker is not None and run.worker.run == name:
                run.worker.send(Pause(name))

    async def resume(self, name: str) -> None:
        """Go on with a paused or failed run, from where it stood or from its last checkpoint."""
        run = self.tree.get(name)
        async with run.lock:
            check_move(name, run.status, Move.RESUME)
            worker = await self.supervisor.worker_for(run)
            self.supervisor.policy.forget(name)
            try:
                self.reports.move(run, Move.RESUME)
            except RunError:  # its rows said that it is finished
                self.pool.release(worker)
                raise
            self.supervisor.begin(run, worker)

    async def stop(self, name: str) -> None:
        """End a run for good; its frames stay."""
        run = self.tree.get(name)
        async with run.lock:
            self.reports.move(run, Move.STOP)
            self._free_worker(run)

    async def rename(self, name: str, label: str) -> None:
        """Give a run a name for people; an empty one takes it away."""
        await self._mark(name, Move.RENAME, label=label)

    async def pin(self, name: str, pinned: bool = True) -> None:
        """Keep a run whatever the budget of the store, or no longer."""
        await self._mark(name, Move.PIN if pinned else Move.UNPIN, pinned=pinned)

    async def delete(self, name: str) -> None:
        """Forget a run and free its room.

        Raises:
            RunError: it computes, is pinned, or other runs branched from it.
        """
        run = self.tree.get(name)
        async with run.lock:
            check_move(name, run.status, Move.DELETE)
            if run.record.pinned:
                raise RunError(f"run {name} is pinned and cannot be deleted; unpin it first")
            children = [child.run for child in self.tree.children(name)]
            if children:
                raise RunError(
                    f"run {name} holds the past of {', '.join(children)} and cannot be deleted; "
                    "delete them first"
                )
            self._free_worker(run)
            await self.supervisor.settle(run)
            await self._store.call(RunDatabase.delete_run, name)
            self.tree.remove(name)
            self.supervisor.policy.forget(name)
            self.controllers.forget(name)
            await asyncio.to_thread(remove_run_files, self._folder, name)
        self.audience.announce(RunRemoved(name))

    async def _mark(self, name: str, move: Move, **fields: str | bool) -> None:
        run = self.tree.get(name)
        async with run.lock:
            check_move(name, run.status, move)
            record = replace(run.record, **fields)  # type: ignore[arg-type]
            await self._store.call(RunDatabase.mark_run, name, record.label, record.pinned)
            run.record = record
        self.audience.announce(RunChanged(self.tree.info(run)))

    # recalculation

    async def recalculate(self, name: str, index: int, revision: int, keep_parent: bool = False) -> Run:
        """Branch a run at a frame with its working list as terrain.

        Args:
            name: the run on the screen.
            index: frame at or before the playback time.
            revision: revision of the working list that is meant.
            keep_parent: whether the run goes on computing beside its child.

        Returns:
            The child.

        Raises:
            RunError: the frame is not computed yet, or the working list has moved on.
            StoreError: the child cannot be stored.
        """
        run = self.tree.get(name)
        async with run.lock:
            check_move(name, run.status, Move.RECALCULATE)
            parent = self.tree.branch_parent(name, index)
            if self.tree.frame(parent.run, index) is None:
                raise RunError(
                    f"frame {index} of run {name} is not computed yet; "
                    f"0 to {run.frame_count - 1} can be branched"
                )
            if revision != run.edit_log.revision:
                raise RunError(
                    f"the edits of run {name} are at revision {run.edit_log.revision}, not {revision}; "
                    "look at them again"
                )
            record = replace(
                parent.record,
                run=_new_id(),
                parent=parent.run,
                branch_index=index,
                status=RunStatus.STARTING.value,
                status_reason="",
                label="",
                pinned=False,
                bed_revision=revision,
                bed_edits=pack_edits(run.edit_log.edits),
            )
            worker = await self._worker_for_child(run, parent, record, keep_parent)
            try:
                events = await self._store.call(RunDatabase.copied_edit_events, name, record.run)
                await self._store.call(RunDatabase.insert_run, record, events)
            except BaseException:
                self.pool.release(worker)
                raise
            child = Run.of(record, events)
            self.tree.add(child)
            self.supervisor.begin(child, worker)
            if not keep_parent and run.status in ACTIVE:
                self.reports.move(run, Move.PAUSE)
        info = self.tree.info(child)
        self.audience.announce(RunChanged(info))
        self.audience.announce(RunBranched(parent.run, info))
        return child

    async def _worker_for_child(self, run: Run, parent: Run, child: RunRecord, keep_parent: bool) -> Worker:
        """The run's own warm worker, or with `keep_parent` another one that finds the state on disk."""
        worker = run.worker
        held = worker is not None and not worker.is_dead and worker.run == run.run
        if worker is not None and held and not keep_parent:
            run.worker = None
            worker.run = child.run
            return worker
        if worker is not None and held:
            await asyncio.wait_for(worker.save_state(parent.run, child.branch_index), SAVE_TIMEOUT_S)
        return await self.pool.take(child.run, self._catalogue.source(child.case), child.device)

    def _free_worker(self, run: Run) -> None:
        if run.worker is not None and run.worker.run == run.run:
            run.worker.send(Pause(run.run, final=True))
            self.pool.release(run.worker)
        run.worker = None


def _new_id() -> str:
    return f"r{secrets.token_hex(6)}"
