"""Workers that live: those that compute, those that hold a paused or finished run, and warm spare ones."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable

from solver_service.errors import RunError
from solver_service.runs.worker import Worker
from solver_service.runs.worker_messages import Report, WorkerSettings
from solver_service.runs.worker_watch import Patience, WorkerWatch

LOG = logging.getLogger(__name__)

MAX_WORKERS = 6
SPARE_DELAY_S = 3.0
"""A taken spare is replaced after this time, so that the new run's first frames do not wait for its start."""


class WorkerPool:
    """Gives workers to runs and takes them back."""

    def __init__(
        self,
        settings: WorkerSettings,
        spare_count: int,
        on_report: Callable[[Worker, Report], None],
        on_lost: Callable[[Worker], None],
        can_leave: Callable[[str], bool],
    ) -> None:
        """A pool without workers.

        Args:
            settings: what each worker is told.
            spare_count: warm workers that stand by.
            on_report: called with every report of a run.
            on_lost: called when a worker died.
            can_leave: whether a run does not need its worker (it is paused or has ended).
        """
        self._settings = settings
        self._spare_count = spare_count
        self._on_report = on_report
        self._on_lost = on_lost
        self._can_leave = can_leave
        self._workers: list[Worker] = []
        self._tasks: set[asyncio.Task[None]] = set()
        self._closing = False

    @property
    def workers(self) -> tuple[Worker, ...]:
        """Every worker that lives."""
        return tuple(self._workers)

    @property
    def devices(self) -> tuple[str, ...]:
        """Devices that runs may ask for, as far as a worker has told."""
        return next((worker.devices for worker in self._workers if worker.devices), ("cpu",))

    def start_spares(self, delay_s: float = 0.0) -> None:
        """See to it that enough warm workers stand by, after a while."""
        task = asyncio.get_running_loop().create_task(self._fill(delay_s))
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    def watch(self, patience: Patience) -> None:
        """Look after the workers, until the pool is closed."""
        task = asyncio.get_running_loop().create_task(WorkerWatch(lambda: self._workers, patience).work())
        self._tasks.add(task)

    async def take(self, run: str, case: str, device: str) -> Worker:
        """A ready worker for a run: a spare one, best one that holds the case, else one that is not needed.

        Raises:
            RunError: all workers compute, or none can be started.
        """
        worker = self._spare(case, device) or self._left_over()
        if worker is None and len(self._living()) >= MAX_WORKERS:
            raise RunError(f"{MAX_WORKERS} runs compute already; pause or stop one")
        if worker is None:
            worker = await self._start(run)
        worker.run = run
        self.start_spares(SPARE_DELAY_S)
        await worker.ready()
        return worker

    def release(self, worker: Worker) -> None:
        """Take a worker back; one spare too many is ended."""
        worker.run = None
        spares = self._spares()
        if len(spares) > self._spare_count:
            self._end(next((w for w in spares if not w.is_ready), worker))

    async def close(self) -> None:
        """End all workers; each writes its checkpoint first."""
        self._closing = True
        for task in self._tasks:
            task.cancel()
        await asyncio.gather(*(worker.quit() for worker in self._workers))

    def _spare(self, case: str, device: str) -> Worker | None:
        spares = self._spares()
        spares.sort(key=lambda worker: (worker.case != (case, device), not worker.is_ready))
        return spares[0] if spares else None

    def _spares(self) -> list[Worker]:
        """Workers without a run that live on: one that was told to end must not be given another."""
        return [worker for worker in self._living() if worker.run is None]

    def _living(self) -> list[Worker]:
        return [worker for worker in self._workers if not (worker.is_ending or worker.is_dead)]

    def _left_over(self) -> Worker | None:
        """With many workers alive, one whose run does not need it; its state is on disk."""
        living = self._living()
        if len(living) < MAX_WORKERS - 1:
            return None
        return next((w for w in living if w.run is not None and self._can_leave(w.run)), None)

    async def _fill(self, delay_s: float) -> None:
        await asyncio.sleep(delay_s)
        while not self._closing and len(self._living()) < MAX_WORKERS:
            if len(self._spares()) >= self._spare_count:
                return
            await self._start()

    async def _start(self, run: str | None = None) -> Worker:
        worker = Worker(self._on_report, self._died)
        worker.run = run  # at once: who asks for a worker while this one starts must not get the same
        self._workers.append(worker)
        await worker.start(self._settings)
        return worker

    def _end(self, worker: Worker) -> None:
        worker.is_ending = True
        task = asyncio.get_running_loop().create_task(worker.quit())
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    def _died(self, worker: Worker) -> None:
        if worker in self._workers:
            self._workers.remove(worker)
        if self._closing:
            return
        LOG.info(
            "worker %d (process %s): %s",
            worker.number,
            worker.pid,
            worker.cause_of_death[1],
            extra={"run": worker.run},
        )
        self._on_lost(worker)
        if worker.run is not None:
            self.start_spares(SPARE_DELAY_S)
