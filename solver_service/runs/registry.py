"""The runs of a service: every command of a viewer or a script ends here.

Lives on one event loop. What a command acknowledges is in the store before the call returns.
"""

from __future__ import annotations

import asyncio
import secrets
from dataclasses import replace
from pathlib import Path

from protocol import CaseSummary, Edit, EditsChanged, RunBranched, RunChanged, RunInfo, check_edit
from solver_service.errors import RunError
from solver_service.runs.audience import Audience
from solver_service.runs.case_catalogue import CaseCatalogue
from solver_service.runs.case_facts import CaseFacts
from solver_service.runs.edit_blobs import pack_edit, pack_edits
from solver_service.runs.run_reports import RunReports
from solver_service.runs.run_status import ACTIVE, RunStatus, check_move
from solver_service.runs.run_tree import Run, RunTree, replayed_log
from solver_service.runs.store_thread import StoreThread
from solver_service.runs.worker import Worker
from solver_service.runs.worker_messages import Begin, Pause, WorkerSettings
from solver_service.runs.worker_pool import WorkerPool
from solver_service.store import (
    DataFolder,
    EditEvent,
    EditEventKind,
    FrameReader,
    FrameRecord,
    RunDatabase,
    RunRecord,
    load_bed,
)
from solver_service.store.checkpoint_store import remove_orphans
from solver_service.store.frame_files import recover_segments

INTERRUPTED = "the service ended while it was computed; resume goes on from the last checkpoint"
SAVE_TIMEOUT_S = 10.0


class RunRegistry:
    """Runs, their workers and their store.

    Attributes:
        audience: who is told of changes.
        tree: all runs.
        pool: the worker processes.
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

        Raises:
            StoreError: the folder is in use or cannot be used.
            CaseError: an offered case cannot be read.
        """
        self._device = device
        self._folder = DataFolder(data_dir)
        self._folder.lock()
        self._catalogue = CaseCatalogue(cases)
        self._store = StoreThread(self._folder)
        self._reader = FrameReader(self._folder)
        self._worker_settings = WorkerSettings(
            data_dir, 0, ring_bytes, checkpoint_interval_s, threads, device
        )
        self._spare_workers = spare_workers
        self.audience = Audience()
        self.tree = RunTree()
        self.reports = RunReports(self.tree, self._store, self.audience)
        self.pool: WorkerPool

    async def open(self) -> None:
        """Take over the store: fence off earlier services, mend what a crash left, warm a worker."""
        self._folder.remove_unfinished()
        epoch = await self._store.call(RunDatabase.begin_epoch)
        active = tuple(status.value for status in ACTIVE)
        await self._store.call(RunDatabase.interrupt_active, active, RunStatus.PAUSED.value, INTERRUPTED)
        for record in await self._store.call(RunDatabase.runs):
            self.tree.add(await self._store.call(_load_run, self._folder, record))
        self.pool = WorkerPool(
            replace(self._worker_settings, epoch=epoch),
            self._spare_workers,
            self.reports.hear,
            self.reports.lost,
            lambda name: name in self.tree and self.tree.get(name).status not in ACTIVE,
        )
        self.pool.start_spares()

    async def close(self) -> None:
        """Pause what computes, end the workers, close the store."""
        computing = [run for run in self.tree if run.status in ACTIVE]
        await self.pool.close()
        for run in computing:
            if run.status in ACTIVE:
                self.reports.move(run, RunStatus.PAUSED, "the service was ended; resume goes on from here")
        self._store.close()
        self._folder.unlock()

    # what there is

    @property
    def cases(self) -> tuple[CaseSummary, ...]:
        """The cases on offer."""
        return self._catalogue.summaries

    def infos(self) -> tuple[RunInfo, ...]:
        """All runs, newest first."""
        return tuple(self.tree.info(run) for run in reversed(list(self.tree)))

    async def read_frame(self, record: FrameRecord) -> bytes:
        """The packed bytes of a frame, read away from the event loop."""
        return await asyncio.to_thread(self._reader.read, record)

    async def read_bed(self, name: str) -> bytes:
        """The packed base bed of a run."""
        return await asyncio.to_thread(load_bed, self._folder, self.tree.get(name).record.case_fingerprint)

    def edits_changed(self, name: str) -> EditsChanged:
        """The working list of a run as it is told to viewers."""
        log = self.tree.get(name).edit_log
        return EditsChanged(name, log.revision, log.edits, log.can_undo, log.can_redo)

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
        run = _fresh(record, ())
        self._begin(run, worker, paused=paused)
        self.audience.announce(RunChanged(self.tree.info(run)))
        return run

    async def pause(self, name: str) -> None:
        """Stop computing a run until `resume`."""
        run = self.tree.get(name)
        async with run.lock:
            self._pause(run)

    async def resume(self, name: str) -> None:
        """Go on with a paused or failed run, from where it stood or from its last checkpoint."""
        run = self.tree.get(name)
        async with run.lock:
            check_move(name, run.status, RunStatus.STARTING)
            worker = run.worker
            if worker is None or worker.is_dead or worker.run != name:
                source = self._catalogue.source(run.record.case)
                worker = await self.pool.take(name, source, run.record.device)
            self.reports.move(run, RunStatus.STARTING)
            self._begin(run, worker)

    async def stop(self, name: str) -> None:
        """End a run for good; its frames stay."""
        run = self.tree.get(name)
        async with run.lock:
            self.reports.move(run, RunStatus.STOPPED)
            if run.worker is not None and run.worker.run == name:
                run.worker.send(Pause(name, final=True))
                self.pool.release(run.worker)
            run.worker = None

    # edits

    async def append_edit(self, name: str, edit: Edit) -> int:
        """Add an edit to the working list; gives the new revision.

        Raises:
            EditError: the edit does not fit the terrain or the list.
        """
        run = self.tree.get(name)
        check_edit(edit, run.facts.grid.geometry)
        return await self._change_edits(run, EditEventKind.APPEND, edit)

    async def undo_edit(self, name: str) -> int:
        """Take the last edit off the working list; gives the new revision."""
        return await self._change_edits(self.tree.get(name), EditEventKind.UNDO)

    async def redo_edit(self, name: str) -> int:
        """Put the edit that was last undone back; gives the new revision."""
        return await self._change_edits(self.tree.get(name), EditEventKind.REDO)

    async def _change_edits(self, run: Run, kind: EditEventKind, edit: Edit | None = None) -> int:
        async with run.lock:
            events = await self._store.call(RunDatabase.edit_events, run.run)
            log = replayed_log(events)  # the change is tried on a copy: it counts once it is stored
            if kind is EditEventKind.APPEND and edit is not None:
                log.append(edit)
            elif kind is EditEventKind.UNDO:
                log.undo()
            else:
                log.redo()
            packed = pack_edit(edit) if edit is not None else b""
            event = EditEvent(run.run, len(events) + 1, kind, packed)
            await self._store.call(RunDatabase.append_edit_event, event)
            run.edit_log = log
        self.audience.announce(self.edits_changed(run.run))
        return log.revision

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
            child = _fresh(record, events)
            self._begin(child, worker)
            if not keep_parent and run.status in ACTIVE:
                self.reports.move(run, RunStatus.PAUSED)
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

    def _pause(self, run: Run) -> None:
        self.reports.move(run, RunStatus.PAUSED)
        if run.worker is not None and run.worker.run == run.run:
            run.worker.send(Pause(run.run))

    def _begin(self, run: Run, worker: Worker, paused: bool = False) -> None:
        """Let a worker compute a run from now on."""
        if run.run not in self.tree:
            self.tree.add(run)
        run.worker, worker.run = worker, run.run
        source = self._catalogue.source(run.record.case)
        worker.case = (source, run.record.device)
        worker.send(
            Begin(
                run=run.run,
                case=source,
                case_fingerprint=run.record.case_fingerprint,
                device=run.record.device,
                legs=self.tree.legs(run.run),
                output_interval=run.record.output_interval,
                last_index=run.last_index,
                stored_frames=run.frame_count,
                paused=paused,
            )
        )


def _new_id() -> str:
    return f"r{secrets.token_hex(6)}"


def _fresh(record: RunRecord, events: tuple[EditEvent, ...]) -> Run:
    facts = CaseFacts.unpack(record.facts)
    return Run(record, facts, replayed_log(events), RunStatus(record.status), record.status_reason, [])


def _load_run(database: RunDatabase, folder: DataFolder, record: RunRecord) -> Run:
    """A run from the store, its files mended."""
    recover_segments(folder, database, record.run)
    remove_orphans(folder, database, record.run)
    run = _fresh(record, tuple(database.edit_events(record.run)))
    run.frames = database.frames(record.run)
    return run
