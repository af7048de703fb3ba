"""What an operator sees at one glance, as plain values: sections of rows by their ids."""

from __future__ import annotations

import asyncio
import os
import shutil
import time
from collections import Counter, deque
from collections.abc import Iterable, Mapping, Set
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import psutil

from protocol import ControlChanged, Notice, Progress, RunRemoved, ServerMessage
from solver_service.runs import RunRegistry
from solver_service.runs.run_status import ACTIVE
from solver_service.runs.run_tree import Run
from solver_service.runs.worker import Worker
from solver_service.uploads.upload_desk import UploadDesk
from solver_service.web.gpu_memory import GpuMemory, gpu_memory
from solver_service.web.stream import StreamConnection
from solver_service.web.version import server_version

Row = dict[str, Any]
Overview = dict[str, dict[str, Row]]

EVENTS_KEPT = 100
SIZES_AGE_S = 10.0
SHOWN_RUNS = 500


class Recent:
    """Hears the runs and remembers the latest of what an operator asks for; a `Listener` of the runs.

    Attributes:
        progress: the latest progress of each run.
        events: the latest notices, oldest first: number, moment, level, text and run.
    """

    def __init__(self) -> None:
        self.progress: dict[str, Progress] = {}
        self.events: deque[Row] = deque(maxlen=EVENTS_KEPT)
        self._count = 0

    def announce(self, message: ServerMessage) -> None:
        """Remember what counts."""
        match message:
            case Progress():
                self.progress[message.run] = message
            case Notice():
                self._count += 1
                row = {"number": self._count, "moment": time.time(), "level": message.level}
                self.events.append({**row, "text": message.text, "run": message.run})
            case RunRemoved():
                self.progress.pop(message.run, None)
            case _:
                pass

    def frame_stored(self, run: str) -> None:
        """Frames are counted by the runs themselves."""


@dataclass
class OverviewSource:
    """Puts the overview together.

    Attributes:
        registry: the runs.
        desk: the uploads.
        connections: the open streams.
        data_dir: the data folder.
        store_bytes: budget of the store; None for none.
        recent: what was heard of the runs.
    """

    registry: RunRegistry
    desk: UploadDesk
    connections: Set[StreamConnection]
    data_dir: Path
    store_bytes: int | None
    recent: Recent = field(default_factory=Recent)
    _sizes: Mapping[str, int] = field(default_factory=dict)
    _sizes_at: float = -1e9
    _gpus: list[GpuMemory] = field(default_factory=list)
    _sent: dict[str, tuple[float, int]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.registry.audience.add(self.recent)

    async def collect(self) -> Overview:
        """The overview now."""
        now = time.monotonic()
        if now - self._sizes_at > SIZES_AGE_S:
            sizes: Counter[str] = Counter()
            for stored in await self.registry.stored_bytes():
                sizes[stored.run] += stored.size
            self._sizes, self._sizes_at = sizes, now
            self._gpus = await asyncio.to_thread(gpu_memory)
        workers = self.registry.pool.workers
        return {
            "service": {"service": self._service(workers)},
            "runs": {run.run: self._run(run) for run in self._newest_runs()},
            "devices": self._devices(workers),
            "gpus": {str(gpu.index): asdict(gpu) for gpu in self._gpus},
            "workers": {str(worker.number): _worker_row(worker) for worker in workers},
            "connections": self._streams(now),
            "uploads": {record.upload: record.facts() for record in self.desk.uploads},
            "events": {str(row["number"]): row for row in self.recent.events},
        }

    def _newest_runs(self) -> list[Run]:
        return list(self.registry.tree)[-SHOWN_RUNS:]

    def _service(self, workers: Iterable[Worker]) -> Row:
        process = psutil.Process()
        disk = shutil.disk_usage(self.data_dir)
        memory = psutil.virtual_memory()
        statuses = [run.status for run in self.registry.tree]
        mib = 1 << 20
        return {
            "version": server_version(),
            "pid": os.getpid(),
            "since": process.create_time(),
            "runs": len(statuses),
            "computing": sum(status in ACTIVE for status in statuses),
            "connections": len(self.connections),
            "memory_bytes": process.memory_info().rss // mib * mib,
            "worker_memory_bytes": sum(_memory(worker.pid) for worker in workers) // mib * mib,
            "machine_memory_bytes": memory.total,
            "machine_memory_free_bytes": memory.available // (16 * mib) * (16 * mib),
            "disk_bytes": disk.total,
            "disk_free_bytes": disk.free // mib * mib,
            "stored_bytes": sum(self._sizes.values()),
            "uploaded_bytes": sum(case.size for case in self.desk.cases),
            "store_bytes": self.store_bytes,
            "longest_publish_wait_s": self.registry.reports.longest_publish_wait_s,
        }

    def _run(self, run: Run) -> Row:
        record, grid = run.record, run.facts.grid
        progress = self.recent.progress.get(run.run)
        control: ControlChanged = self.registry.controllers.of(run.run)
        # the time of the last stored frame is what a viewer can see
        at = max(run.frame_count - 1, 0) * record.output_interval
        row = {
            "run": run.run,
            "case": record.case,
            "title": record.title,
            "label": record.label,
            "parent": record.parent,
            "status": str(run.status.value),
            "reason": run.reason,
            "device": record.device,
            "cells": grid.nrows * grid.ncols,
            "frames": run.frame_count,
            "time": min(at, record.duration),
            "duration": record.duration,
            "pinned": record.pinned,
            "size": self._sizes.get(run.run, 0),
            "controller": control.session,
            "controller_client": control.client,
            "viewers": sum(connection.feed.run == run.run for connection in self.connections),
        }
        computes = run.status in ACTIVE
        if progress is not None:
            row["volume_error"] = float(f"{progress.volume_error_relative:.2g}")
            row["dt"] = float(f"{progress.dt:.3g}")
            row["speed"] = float(f"{progress.speed_x_real_time:.3g}") if computes else None
            row["eta_s"] = round(progress.eta_s) if computes and progress.eta_s is not None else None
        return row

    def _devices(self, workers: Iterable[Worker]) -> dict[str, Row]:
        computing = [run for run in self.registry.tree if run.status in ACTIVE]
        names = dict.fromkeys((*self.registry.pool.devices, *(run.record.device for run in computing)))
        rows: dict[str, Row] = {}
        for name in names:
            runs = [run for run in computing if run.record.device == name]
            cells = sum(run.facts.grid.nrows * run.facts.grid.ncols for run in runs)
            held = sum(worker.case is not None and worker.case[1] == name for worker in workers)
            rows[name] = {"device": name, "runs": len(runs), "cells": cells, "workers": held}
        return rows

    def _streams(self, now: float) -> dict[str, Row]:
        rows: dict[str, Row] = {}
        sent: dict[str, tuple[float, int]] = {}
        for connection in sorted(self.connections, key=lambda each: each.name):
            row = connection.facts()
            name, total = row["session"], row.pop("bytes_sent")
            before, was = self._sent.get(name, (now, total))
            row["bytes_per_s"] = round((total - was) / (now - before), -2) if now > before else 0.0
            sent[name], rows[name] = (now, total), row
        self._sent = sent
        return rows


def changes(before: Overview, after: Overview) -> Row | None:
    """What is new, changed or gone between two overviews; None for nothing.

    Returns:
        `set`: rows by section and id; `gone`: ids by section.
    """
    new: dict[str, dict[str, Row]] = {}
    gone: dict[str, list[str]] = {}
    for section, rows in after.items():
        old = before.get(section, {})
        changed = {name: row for name, row in rows.items() if old.get(name) != row}
        left = [name for name in old if name not in rows]
        if changed:
            new[section] = changed
        if left:
            gone[section] = left
    return {"set": new, "gone": gone} if new or gone else None


def _worker_row(worker: Worker) -> Row:
    return {
        "worker": worker.number,
        "pid": worker.pid,
        "run": worker.run,
        "device": worker.case[1] if worker.case is not None else None,
        "ready": worker.is_ready,
        "memory_bytes": _memory(worker.pid) // (1 << 20) * (1 << 20),
    }


def _memory(pid: int | None) -> int:
    """Memory of a process [bytes]; 0 where it is gone."""
    try:
        return int(psutil.Process(pid).memory_info().rss) if pid is not None else 0
    except psutil.NoSuchProcess:
        return 0
