"""What a monitoring system asks: `/metrics` in the text format of Prometheus, and readiness."""

from __future__ import annotations

import os
import shutil
from collections import Counter
from collections.abc import Iterator, Mapping, Sized
from pathlib import Path

import psutil
from prometheus_client import CollectorRegistry
from prometheus_client.core import CounterMetricFamily, GaugeMetricFamily, Metric
from prometheus_client.exposition import CONTENT_TYPE_PLAIN_0_0_4, generate_latest

from solver_service.runs import RunRegistry, RunStatus
from solver_service.runs.worker import Worker
from solver_service.store import StoredBytes
from solver_service.store.schema import STORED_KINDS
from solver_service.web.gpu_memory import gpu_memory
from solver_service.web.loop_lag import LoopLag
from solver_service.web.quotas import Quotas
from solver_service.web.version import server_version

CONTENT_TYPE = CONTENT_TYPE_PLAIN_0_0_4


class Metrics:
    """The metrics of a service.

    Attributes:
        loop_lag: keeps how late the event loop is; its `work` is to run beside the service.
    """

    def __init__(self, registry: RunRegistry, quotas: Quotas, connections: Sized, data_dir: Path) -> None:
        """Look at a service.

        Args:
            registry: its runs.
            quotas: how much each token may take.
            connections: the open streams.
            data_dir: the data folder.
        """
        self._runs = registry
        self._quotas = quotas
        self._connections = connections
        self._data_dir = data_dir
        self._stored: list[StoredBytes] = []
        self._families = CollectorRegistry(auto_describe=False)
        self.loop_lag = LoopLag(self._families)
        self._families.register(self)

    async def text(self) -> bytes:
        """All metrics now.

        Raises:
            StoreError: the rows of the store cannot be read.
        """
        self._stored = await self._runs.stored_bytes()
        return generate_latest(self._families)

    def collect(self) -> Iterator[Metric]:
        """The families whose values are looked up; called for each answer."""
        yield _gauge("fev_info", "The version that runs.", "version", {server_version(): 1})
        yield GaugeMetricFamily("fev_connections", "Open streams.", len(self._connections))
        statuses = Counter(run.status for run in self._runs.tree)
        by_status = {status.value: statuses[status] for status in RunStatus}
        yield _gauge("fev_runs", "Runs by status.", "status", by_status)
        yield from _worker_families(self._runs.pool.workers)
        yield GaugeMetricFamily(
            "fev_longest_publish_wait_seconds",
            "Longest wait of a worker to publish a frame since the start.",
            self._runs.reports.longest_publish_wait_s,
        )
        kinds = Counter(dict.fromkeys(STORED_KINDS, 0))
        for stored in self._stored:
            kinds[stored.kind] += stored.size
        yield _gauge("fev_store_bytes", "What the runs keep on disk, by kind.", "kind", kinds)
        free = shutil.disk_usage(self._data_dir).free
        yield GaugeMetricFamily("fev_data_free_bytes", "Room on the disk of the data folder.", free)
        refusals = CounterMetricFamily(
            "fev_quota_refusals", "What was refused for the limits of a token, by limit.", labels=["limit"]
        )
        for limit, count in self._quotas.refusals.items():
            refusals.add_metric([limit], count)
        yield refusals
        yield from _gpu_families()
        process = psutil.Process()
        memory = process.memory_info().rss
        yield GaugeMetricFamily("process_resident_memory_bytes", "Memory of the web process.", memory)
        yield CounterMetricFamily("process_cpu_seconds", "CPU time of the web process.", _cpu_s(process))
        yield GaugeMetricFamily("process_start_time_seconds", "Start, since 1970.", process.create_time())


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


def _gauge(name: str, meaning: str, label: str, values: Mapping[str, float]) -> GaugeMetricFamily:
    family = GaugeMetricFamily(name, meaning, labels=[label])
    for value, number in values.items():
        family.add_metric([value], number)
    return family


def _worker_families(workers: tuple[Worker, ...]) -> Iterator[Metric]:
    yield GaugeMetricFamily("fev_workers", "Worker processes that live.", len(workers))
    holding = sum(worker.run is not None for worker in workers)
    yield GaugeMetricFamily("fev_workers_with_run", "Worker processes that hold a run.", holding)
    memory = GaugeMetricFamily(
        "fev_worker_resident_memory_bytes", "Memory of a worker process.", labels=["worker"]
    )
    cpu = CounterMetricFamily("fev_worker_cpu_seconds", "CPU time of a worker process.", labels=["worker"])
    for worker in workers:
        if worker.pid is None:
            continue
        try:
            process = psutil.Process(worker.pid)
            memory.add_metric([str(worker.number)], process.memory_info().rss)
            cpu.add_metric([str(worker.number)], _cpu_s(process))
        except psutil.NoSuchProcess:
            continue  # it died while we asked
    yield memory
    yield cpu


def _gpu_families() -> Iterator[Metric]:
    used = GaugeMetricFamily("fev_gpu_memory_used_bytes", "Memory in use.", labels=["gpu", "name"])
    total = GaugeMetricFamily("fev_gpu_memory_bytes", "Memory of a GPU.", labels=["gpu", "name"])
    for gpu in gpu_memory():
        used.add_metric([str(gpu.index), gpu.name], gpu.used_bytes)
        total.add_metric([str(gpu.index), gpu.name], gpu.total_bytes)
    yield used
    yield total


def _cpu_s(process: psutil.Process) -> float:
    times = process.cpu_times()
    return times.user + times.system
