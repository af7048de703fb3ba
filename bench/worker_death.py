"""From kill -9 of a worker to the sentence that a viewer reads, and to its first new frame."""

from __future__ import annotations

import os
import signal
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import psutil

import protocol
from bench.service_process import ServiceClient, ServiceProcess

COUNT = 20


def figures(smoke: bool) -> Iterator[dict[str, object]]:
    """Delays over so many deaths of the worker of one run of the embedded case."""
    told, restarted = [], []
    count = 3 if smoke else COUNT
    with (
        tempfile.TemporaryDirectory(prefix="fev-bench-") as folder,
        ServiceProcess(Path(folder), restart_attempts=10 * count, checkpoint_interval_s=1.0) as service,
        ServiceClient(service) as client,
    ):
        run = str(client.do(protocol.StartRun, case="jacksboro", duration=1e6)["run"])
        client.do(protocol.Subscribe, run=run, from_index=0, mode="live", credit=8)
        for _ in range(count):
            last = client.first(protocol.Frame).index
            worker = _busiest(service.process.pid)
            begun = time.perf_counter()
            os.kill(worker, signal.SIGKILL)
            client.first(protocol.Notice)
            told.append(time.perf_counter() - begun)
            client.first(protocol.Frame, lambda frame, last=last: frame.index > last + 1)
            restarted.append(time.perf_counter() - begun)
    for name, values in (("told", told), ("new_frame", restarted)):
        for quantile in (50, 100):
            yield {
                "figure": f"worker_death_to_{name}_p{quantile}",
                "value": round(float(np.percentile(values, quantile)), 4),
                "unit": "s",
                "case": "jacksboro",
                "count": count,
            }


def _busiest(service: int) -> int:
    """The worker that computes: the child of the service that has used most processor time just now."""
    children = psutil.Process(service).children()
    before = {child.pid: sum(child.cpu_times()[:2]) for child in children}
    time.sleep(0.3)
    return max(children, key=lambda child: sum(child.cpu_times()[:2]) - before[child.pid]).pid
