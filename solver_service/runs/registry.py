"""The runs of a service: every command of a viewer or a script ends here.

Lives on one event loop. What a command acknowledges is in the store before the call returns.
"""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Coroutine
from dataclasses import replace
from pathlib import Path
from typing import Any

from protocol import CHANNEL_NAMES, CaseSummary, Layer, RunInfo
from solver_service.errors import StoreError
from solver_service.runs.audience import Audience
from solver_service.runs.branching import Branching
from solver_service.runs.case_catalogue import CaseCatalogue
from solver_service.runs.channel_desk import ChannelDesk
from solver_service.runs.channels import kept_channels
from solver_service.runs.controllers import Controllers
from solver_service.runs.edit_desk import EditDesk
from solver_service.runs.forcing_desk import ForcingDesk
from solver_service.runs.housekeeper import Housekeeper, RoomRules
from solver_service.runs.presentations import Presentations
from solver_service.runs.recent_frames import RecentFrames
from solver_service.runs.restart_policy import RestartPolicy
from solver_service.runs.run_control import RunControl
from solver_service.runs.run_reports import RunReports
from solver_service.runs.run_status import ACTIVE, Move, RunStatus
from solver_service.runs.run_tree import RunTree
from solver_service.runs.store_thread import StoreThread
from solver_service.runs.supervisor import Supervisor, load_run
from solver_service.runs.worker_messages import WorkerSettings
from solver_service.runs.worker_pool import WorkerPool
from solver_service.runs.worker_watch import Patience
from solver_service.store import (
    DataFolder,
    FrameReader,
    FrameRecord,
    RunDatabase,
    StoredBytes,
    load_bed,
    load_layer,
)

INTERRUPTED = "the service ended while it was computed; resume goes on from the last checkpoint"
LOG = logging.getLogger(__name__)

CLOSE_TIMEOUT_S = 1.0


class RunRegistry:
    """Runs, their workers and their store.

    Attributes:
        audience: who is told of changes.
        tree: all runs.
        edits: their working lists of edits.
        forcing: their working forcing.
        controllers: who may change them.
        presentations: who shows a view to the others.
        supervisor: their workers.
        control: starts, pauses, ends and marks them.
        branching: makes their children.
        channels: reads what they keep beside the depth.
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
        log_format: str = "text",
        log_level: str = "warning",
        patience: Patience | None = None,
        channels: tuple[str, ...] = CHANNEL_NAMES,
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
            log_format: "text" or "json", for the lines of the workers.
            log_level: least level of these lines.
            patience: how long a worker may show nothing before it is taken to hang.
            channels: what runs may keep beside the depth.

        Raises:
            StoreError: the folder is in use or cannot be used.
            CaseError: an offered case cannot be read.
        """
        self._catalogue = CaseCatalogue(cases)
        self._folder = DataFolder(data_dir)
        self._folder.lock()
        self._store = StoreThread(self._folder)
        self._reader = FrameReader(self._folder)
        self._recent = RecentFrames(self._read_frame)
        self._worker_settings = WorkerSettings(
            data_dir, 0, ring_bytes, checkpoint_interval_s, threads, device, log_format, log_level
        )
        self._spare_workers = spare_workers
        self._room = room or RoomRules()
        self._patience = patience or Patience()
        self._housekeeping: asyncio.Task[None]
        self._commands: set[asyncio.Task[None]] = set()
        self.audience = Audience()
        self.tree = RunTree()
        self.reports = RunReports(self.tree, self._store, self.audience)
        self.controllers = Controllers(self.audience.announce)
        self.presentations = Presentations(self.audience.announce)
        self.edits = EditDesk(self.tree, self._store, self.audience)
        self.forcing = ForcingDesk(self.tree, self._store, self.audience)
        policy = RestartPolicy(restart_attempts, restart_within_s)
        self.supervisor = Supervisor(
            self.tree, self._store, self._folder, self._catalogue, self.reports, policy
        )
        self.control = RunControl(
            self.tree,
            self._store,
            self._folder,
            self._catalogue,
            self.controllers,
            self.supervisor,
            self.reports,
            self.audience,
            device,
            kept_channels(channels),
        )
        self.channels = ChannelDesk(self.tree, self._store, self._reader)
        self.branching = Branching(
            self.tree, self._store, self._catalogue, self.supervisor, self.reports, self.audience
        )

    async def open(self) -> None:
        """Take over the store: fence off earlier services, mend what a crash left, warm a worker."""
        epoch = await self._store.call(RunDatabase.begin_epoch)
        self._folder.remove_unfinished()
        active = tuple(status.value for status in ACTIVE)
        await self._store.call(RunDatabase.interrupt_active, active, RunStatus.PAUSED.value, INTERRUPTED)
        for record in await self._store.call(RunDatabase.runs):
            self.tree.add(await self._store.call(load_run, self._folder, record))
        keeper = Housekeeper(
            self.control, self.tree, self._store, self._folder, self.reports, self._room, epoch
        )
        self._housekeeping = asyncio.get_running_loop().create_task(keeper.work())
        self.supervisor.pool = WorkerPool(
            replace(self._worker_settings, epoch=epoch),
            self._spare_workers,
            self.supervisor.hear,
            self.supervisor.lost,
            lambda name: name in self.tree and self.tree.get(name).status not in ACTIVE,
        )
        self.pool.start_spares()
        self.pool.watch(self._patience)

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
    def catalogue(self) -> CaseCatalogue:
        """The cases on offer, by name."""
        return self._catalogue

    @property
    def cases(self) -> tuple[CaseSummary, ...]:
        """The cases on offer."""
        return self._catalogue.summaries

    def case(self, name: str) -> CaseSummary | None:
        """A case on offer, or None."""
        return self._catalogue.find(name)

    async def stored_bytes(self) -> list[StoredBytes]:
        """Room that each run takes in the store, by kind."""
        return await self._store.call(RunDatabase.stored_bytes)

    def infos(self) -> tuple[RunInfo, ...]:
        """All runs, newest first."""
        return tuple(self.tree.info(run) for run in reversed(list(self.tree)))

    @property
    def pool(self) -> WorkerPool:
        """The worker processes."""
        return self.supervisor.pool

    async def read_frame(self, record: FrameRecord) -> bytes:
        """The packed bytes of a frame, read away from the event loop and once for all who want it.

        Raises:
            StoreError: they are missing or damaged.
        """
        return await self._recent.get(record)

    async def _read_frame(self, record: FrameRecord) -> bytes:
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

    async def read_layer(self, name: str, layer: Layer) -> bytes:
        """The file of a picture of the terrain of a run."""
        fingerprint = self.tree.get(name).record.case_fingerprint
        return await asyncio.to_thread(load_layer, self._folder, fingerprint, layer)
