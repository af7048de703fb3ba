"""What workers tell of their runs, turned into status moves, rows and announcements."""

from __future__ import annotations

import asyncio
import logging
from typing import Literal

from protocol import Notice, Progress, RunChanged, WaterBudget
from solver_service.errors import RunError
from solver_service.runs.audience import Audience
from solver_service.runs.run_status import ACTIVE, Move, RunStatus, check_move
from solver_service.runs.run_tree import Run, RunTree
from solver_service.runs.store_thread import StoreThread
from solver_service.runs.worker import Worker
from solver_service.runs.worker_messages import (
    BudgetReport,
    CheckpointStored,
    Failed,
    FrameStored,
    Paused,
    ProgressReport,
    Remark,
    Report,
    Running,
)
from solver_service.store import FrameRecord, RunDatabase

LOG = logging.getLogger(__name__)

RUN_CHANGED_INTERVAL_S = 0.25
TEXT_LENGTH = 2000
BALANCE = (
    "initial",
    "stored",
    "inflow",
    "outflow",
    "rain",
    "infiltration",
    "edits",
    "error",
    "error_relative",
)
"""The sums of a volume budget, by their names in the solver and on the wire."""


class RunReports:
    """Hears the reports of all workers on the event loop."""

    def __init__(self, tree: RunTree, store: StoreThread, audience: Audience) -> None:
        self._tree = tree
        self._store = store
        self._audience = audience
        self._announced_soon: set[str] = set()
        self.longest_publish_wait_s = 0.0

    def move(self, run: Run, move: Move, reason: str = "") -> None:
        """Move a run to a status, in memory at once and in the store in its turn, and tell everybody.

        Raises:
            RunError: the move is not legal.
        """
        status = check_move(run.run, run.status, move)
        run.lacks_room = False
        run.status, run.reason = status, reason[:TEXT_LENGTH]
        self._store.later(RunDatabase.set_status, run.run, status.value, run.reason)
        self._audience.announce(RunChanged(self._tree.info(run)))

    def hear(self, worker: Worker, report: Report) -> None:
        """Take a report in."""
        match report:
            case FrameStored():
                self._frame_stored(report)
            case ProgressReport():
                self._audience.announce(_progress(report))
            case BudgetReport():
                self._audience.announce(_water_budget(report))
            case Running():
                run = self._tree.get(report.run)
                if run.status is RunStatus.STARTING:
                    self.move(run, Move.BEGIN)
            case Paused() if report.number and worker.holds.get(report.run, 0) > report.number:
                LOG.debug("run %s goes on already", report.run)
            case Paused():
                run = self._tree.get(report.run)
                if run.status in ACTIVE:
                    self.move(run, Move.WAIT, report.message)
                    run.lacks_room = report.lacks_room
                if report.message:
                    self.notice("error", f"paused: {report.message}", report.run)
            case Failed():
                self._failed(worker, report)
            case Remark():
                self.notice("warning", report.message, report.run)
            case CheckpointStored():
                LOG.debug("checkpoint at %s s", report.checkpoint.time, extra={"run": report.checkpoint.run})

    def frames_found(self, run: Run, frames: list[FrameRecord]) -> None:
        """Believe the rows of a run for which nobody writes: some may never have been reported."""
        run.frames = frames
        self._audience.frame_stored(run.run)
        if run.frame_count > run.last_index and run.status in (*ACTIVE, RunStatus.PAUSED):
            self.move(run, Move.FINISH)

    def _frame_stored(self, report: FrameStored) -> None:
        frame = report.frame
        run = self._tree.get(frame.run)
        self.longest_publish_wait_s = max(self.longest_publish_wait_s, report.waited_s)
        if frame.index != run.frame_count:
            raise RunError(f"run {run.run} stored frame {frame.index} where {run.frame_count} was due")
        run.frames.append(frame)
        self._audience.frame_stored(run.run)
        if frame.index >= run.last_index and run.status in (*ACTIVE, RunStatus.PAUSED):
            self.move(run, Move.FINISH)
        elif run.run not in self._announced_soon:
            self._announced_soon.add(run.run)
            asyncio.get_running_loop().call_later(RUN_CHANGED_INTERVAL_S, self._announce, run)

    def _announce(self, run: Run) -> None:
        self._announced_soon.discard(run.run)
        if run.run not in self._tree:
            return  # it was deleted meanwhile
        self._audience.announce(RunChanged(self._tree.info(run)))

    def _failed(self, worker: Worker, report: Failed) -> None:
        worker.case = None
        if report.run not in self._tree:
            LOG.error("worker %d: %s", worker.number, report.message, extra={"run": report.run})
            return
        run = self._tree.get(report.run)
        if run.status in ACTIVE:
            self.move(run, Move.FAIL, report.message)
        self.notice("error", f"failed: {report.message}", report.run)

    def notice(self, level: Literal["info", "warning", "error"], text: str, run: str) -> None:
        """Tell everybody something that a person should read."""
        LOG.warning("%s", text, extra={"run": run})
        self._audience.announce(Notice(level, text[:TEXT_LENGTH], run))


def _progress(report: ProgressReport) -> Progress:
    return Progress(
        run=report.run,
        time=report.time,
        steps=report.steps,
        dt=report.dt,
        speed_x_real_time=report.speed_x_real_time,
        wall_s=report.wall_s,
        cell_steps_per_s=report.cell_steps_per_s,
        volume_error_relative=report.volume_error_relative,
        wet_cells=report.wet_cells,
        limiting_cell=report.limiting_cell,
        eta_s=report.eta_s,
    )


def _water_budget(report: BudgetReport) -> WaterBudget:
    budget = report.budget
    return WaterBudget(
        run=report.run,
        time=report.time,
        **{name: budget[name] for name in BALANCE},
        sources=dict(budget["sources"]),
        edges_in={name: edge["in"] for name, edge in budget["edges"].items()},
        edges_out={name: edge["out"] for name, edge in budget["edges"].items()},
        structures=dict(budget["structures"]),
        moved=dict(budget["moved"]),
    )
