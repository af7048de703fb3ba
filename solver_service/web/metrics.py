"""What a monitoring system asks: `/metrics` in the text format of Prometheus 0.0.4, and readiness."""

from __future__ import annotations

import os
import shutil
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

import psutil

from solver_service.runs import RunRegistry
from solver_service.runs.run_status import RunStatus
from solver_service.web.quotas import Quotas
from solver_service.web.version import server_version

CONTENT_TYPE = "text/plain; version=0.0.4; charset=utf-8"


@dataclass(frozen=True)
class Family:
    """One family of metrics.

    Attributes:
        name: its name, with its unit.
        meaning: one line.
        values: values by labels (name, value); () for the one without labels.
        kind: gauge, or counter for what only grows.
    """

    name: str
    meaning: str
    values: Mapping[tuple[tuple[str, str], ...], float] = field(default_factory=dict)
    kind: Literal["gauge", "counter"] = "gauge"

    def lines(self) -> list[str]:
        """Its lines in the text format."""
        found = [f"# HELP {self.name} {self.meaning}", f"# TYPE {self.name} {self.kind}"]
        for labels, value in self.values.items():
            inner = ",".join(f'{name}="{_escaped(text)}"' for name, text in labels)
            found.append(f"{self.name}{{{inner}}} {value!r}" if inner else f"{self.name} {value!r}")
        return found


def metrics_text(registry: RunRegistry, quotas: Quotas, connections: int, data_dir: Path) -> str:
    """All metrics of a service.

    Args:
        registry: its runs.
        quotas: how much each token may take.
        connections: how many streams are open.
        data_dir: the data folder.
    """
    statuses = Counter(run.status for run in registry.tree)
    process = psutil.Process()
    workers = registry.pool.workers
    families = [
        Family("fev_info", "The version that runs.", {(("version", server_version()),): 1}),
        Family("fev_connections", "Open streams.", {(): connections}),
        Family(
            "fev_runs",
            "Runs by status.",
            {(("status", status.value),): statuses[status] for status in RunStatus},
        ),
        Family("fev_workers", "Worker processes that live.", {(): len(workers)}),
        Family(
            "fev_workers_with_run",
            "Worker processes that hold a run.",
            {(): sum(worker.run is not None for worker in workers)},
        ),
        Family(
            "fev_longest_publish_wait_seconds",
            "Longest wait of a worker to publish a frame since the start.",
            {(): registry.reports.longest_publish_wait_s},
        ),
        Family(
            "fev_data_free_bytes",
            "Room on the disk of the data folder.",
            {(): shutil.disk_usage(data_dir).free},
        ),
        Family(
            "process_resident_memory_bytes",
            "Memory of the web process.",
            {(): process.memory_info().rss},
        ),
        Family(
            "fev_quota_refusals_total",
            "What was refused for the limits of a token, by limit.",
            {(("limit", name),): count for name, count in quotas.refusals.items()},
            "counter",
        ),
        Family("process_start_time_seconds", "Start, since 1970.", {(): process.create_time()}),
    ]
    return "".join(f"{line}\n" for family in families for line in family.lines())


def unready_reason(accepts: bool, data_dir: Path) -> str | None:
    """Why the service should get no new viewers now; None when it is ready.

    Args:
        accepts: whether it has started and is not ending.
        data_dir: the data folder.
    """
    if not accepts:
        return "the service is starting or ending"
    if not os.access(data_dir / "runs.sqlite", os.W_OK):
        return f"the runs in the data folder {data_dir} cannot be written"
    return None


def _escaped(text: str) -> str:
    return text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
