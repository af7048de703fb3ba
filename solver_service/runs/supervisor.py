"""Gives runs their workers, notices when one dies, and lets another take its run up by policy.

Two workers never write for one run: whoever takes a run up waits until the worker that had it before has
nothing of it on the way to the disk any more, and then believes the rows of the store alone.
"""

from __future__ import annotations

import asyncio
import itertools
import logging

from solver_service.errors import RunError, ServiceError
from solver_service.runs.case_catalogue import CaseCatalogue
from solver_service.runs.channels import kept_channels
from solver_service.runs.forced_course import WorkingForcing
from solver_service.runs.restart_policy import RestartPolicy
from solver_service.runs.run_reports import RunReports
from solver_service.runs.run_status import ACTIVE, Move, RunStatus
from solver_service.runs.run_tree import Run, RunTree
from solver_service.runs.store_thread import StoreThread
from solver_service.runs.worker import Worker
from solver_service.runs.worker_messages import Begin, Left, Report
from solver_service.runs.worker_pool import WorkerPool
from solver_service.store import DataFolder, FrameRecord, RunDatabase, RunRecord, mend_run

LOG = logging.getLogger(__name__)

LEAVE_TIMEOUT_S = 20.0


class Supervisor:
    """The link between runs and workers.

    Attributes:
        pool: the worker processes.
        policy: how often a run is restarted.
    """

    def __init__(
        self,
        tree: RunTree,
        store: StoreThread,
        folder: DataFolder,
        catalogue: CaseCatalogue,
        reports: RunReports,
        policy: RestartPolicy,
    ) -> None:
        """A supervisor without workers; `pool` is set before the first run."""
        self.policy = policy
        self.pool: WorkerPool
        self._tree = tree
        self._store = store
        self._folder = folder
        self._catalogue = catalogue
        self._reports = reports
        self._numbers = itertools.count(1)
        self._waiting: list[asyncio.Future[None]] = []
        self._tasks: set[asyncio.Task[None]] = set()

    async def worker_for(self, run: Run) -> Worker:
        """The worker that goes on with a run: its own where that lives, else another.

        Raises:
            RunError: all workers compute, or the last frames of the run are still on their way.
        """
        worker = run.worker
        if worker is not None and not worker.is_dead and worker.run == run.run:
            return worker
        await self.settle(run)
        return await self.pool.take(run.run, self._catalogue.source(run.record.case), run.record.device)

    async def settle(self, run: Run) -> None:
        """Wait until no worker writes for a run, then take over what its rows say.

        Raises:
            RunError: its last frames are still on their way.
        """
        try:
            async with asyncio.timeout(LEAVE_TIMEOUT_S):
                while any(run.run in worker.holds for worker in self.pool.workers):
                    waiting: asyncio.Future[None] = asyncio.get_running_loop().create_future()
                    self._waiting.append(waiting)
                    await waiting
        except TimeoutError:
            raise RunError(
                f"the last frames of run {run.run} are still on their way to the disk; try again"
            ) from None
        frames = await self._store.call(_mended_frames, self._folder, run.run)
        self._reports.frames_found(run, frames)

    def begin(self, run: Run, worker: Worker, paused: bool = False) -> None:
        """Let a worker compute a run from now on."""
        run.worker, worker.run = worker, run.run
        source = self._catalogue.source(run.record.case)
        worker.case = (source, run.record.device)
        worker.send(
            Begin(
                run=run.run,
                case=source,
                case_fingerprint=run.record.case_fingerprint,
                device=run.record.device,
                legs=self._tree.legs(run.run),
                output_interval=run.record.output_interval,
                last_index=run.last_index,
                paused=paused,
                number=next(self._numbers),
                channels=kept_channels(run.record.channel_names),
            )
        )

    def hear(self, worker: Worker, report: Report) -> None:
        """Take the report of a worker in."""
        if isinstance(report, Left):
            self._wake()
        else:
            self._reports.hear(worker, report)

    def lost(self, worker: Worker) -> None:
        """A worker died."""
        self._wake()
        if worker.run is None or worker.run not in self._tree:
            return  # a spare one, or it was loading a case: whoever waits for that is told
        run = self._tree.get(worker.run)
        if run.worker is worker:
            run.worker = None
        if run.status not in ACTIVE:
            return
        kind, words = worker.cause_of_death
        attempt = self.policy.grant(run.run, kind)
        if attempt:
            reason = f"{words}; going on from the last checkpoint"
            self._reports.move(run, Move.RESTART, reason)
            self._reports.notice(
                "warning", f"{reason} (restart {attempt} of {self.policy.attempts})", run.run
            )
            task = asyncio.get_running_loop().create_task(self._restart(run))
            self._tasks.add(task)
            task.add_done_callback(self._tasks.discard)
        else:
            reason = f"{words}; resume goes on from the last checkpoint"
            self._reports.move(run, Move.FAIL, reason)
            self._reports.notice("error", f"failed: {reason}", run.run)

    async def close(self) -> None:
        """Restart nothing more and end the workers."""
        for task in self._tasks:
            task.cancel()
        await self.pool.close()

    async def _restart(self, run: Run) -> None:
        async with run.lock:
            if not _waits_for_worker(run):
                return  # somebody paused, stopped or resumed it meanwhile
            try:
                worker = await self.worker_for(run)
            except ServiceError as error:
                self._reports.move(run, Move.FAIL, str(error))
                self._reports.notice("error", f"failed: {error}", run.run)
                return
            if _waits_for_worker(run):
                self.begin(run, worker)
            else:  # its rows said that it is finished
                self.pool.release(worker)

    def _wake(self) -> None:
        waiting, self._waiting = self._waiting, []
        for each in waiting:
            if not each.done():
                each.set_result(None)


def _waits_for_worker(run: Run) -> bool:
    return run.status is RunStatus.STARTING and run.worker is None


def _mended_frames(database: RunDatabase, folder: DataFolder, run: str) -> list[FrameRecord]:
    mend_run(folder, database, run)
    return database.frames(run)


def load_run(database: RunDatabase, folder: DataFolder, record: RunRecord) -> Run:
    """A run from the store, its files mended; for the start of a service."""
    forcing = [WorkingForcing.of(event) for event in database.forcing_events(record.run)[-1:]]
    run = Run.of(record, database.edit_events(record.run), *forcing)
    run.frames = _mended_frames(database, folder, record.run)
    return run
