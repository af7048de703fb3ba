"""Replay from the store over a real socket: rate, bits, gaps, lag of the event loop; publishing's wait.

The flood is a lake over a third and more of 2113 x 1949 cells that sloshes, so that frames are large and
differ. The viewer decodes every frame and pays for it with one credit. Another process pings meanwhile.
"""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np

import protocol
from bench.loop_lag import LoopLag
from bench.service_process import ServiceClient, ServiceProcess
from bench.slosh import write_slosh_case
from protocol import BlockLayout

FULL = (1949, 2113)
SMOKE = (256, 256)
FRAMES = 40
SMOKE_FRAMES = 12
INTERVAL = 2.0
CREDIT = 4


def figures(smoke: bool) -> Iterator[dict[str, object]]:
    """Replay and publishing figures."""
    nrows, ncols = SMOKE if smoke else FULL
    frames = SMOKE_FRAMES if smoke else FRAMES
    seconds = 1.0 if smoke else 60.0
    with tempfile.TemporaryDirectory(prefix="fev-bench-") as folder:
        case = write_slosh_case(Path(folder) / "slosh", nrows, ncols, INTERVAL * frames, INTERVAL)
        with ServiceProcess(Path(folder) / "data", cases=[str(case)]) as service:
            with ServiceClient(service) as client:
                run = str(client.do(protocol.StartRun, case=str(case))["run"])
                client.until(_finished(run), timeout_s=600.0)
            waited_ms = 1e3 * service.status()["longest_publish_wait_s"]
            yield {
                "figure": "longest_publish_wait",
                "value": round(waited_ms, 3),
                "unit": "ms",
                "frames": frames,
            }
            yield from _replay(service, run, BlockLayout(nrows, ncols), frames, seconds)


def _replay(
    service: ServiceProcess, run: str, layout: BlockLayout, last: int, seconds: float
) -> Iterator[dict[str, object]]:
    arrivals, sizes, wet = [], [], []
    before = service.metrics()
    with LoopLag(service) as lag, ServiceClient(service, layout=layout) as client:
        client.do(protocol.Subscribe, run=run, from_index=0, mode="replay", credit=CREDIT)
        begun = time.perf_counter()
        while time.perf_counter() - begun < seconds:
            frame = client.first(protocol.Frame)
            arrivals.append(time.perf_counter())
            sizes.append(len(frame.payload) + len(frame.states))
            decoded = client.decoded.pop((frame.run, frame.index))
            wet.append(np.count_nonzero(decoded.q) / decoded.q.size)
            if frame.index == last:
                client.do(protocol.Seek, run=run, index=0)
        wall = arrivals[-1] - begun
    gaps = np.diff(arrivals)
    about = {
        "cells": layout.nrows * layout.ncols,
        "wet_share": round(float(np.mean(wet)), 3),
        "frames": len(sizes),
    }
    yield {"figure": "replay_rate", "value": round(len(sizes) / wall, 1), "unit": "frames/s", **about}
    yield {
        "figure": "replay_bits_at_20_frames_per_s",
        "value": round(8e-6 * 20.0 * float(np.mean(sizes)), 1),
        "unit": "Mbit/s",
        **about,
    }
    yield {"figure": "replay_bits", "value": round(8e-6 * sum(sizes) / wall, 1), "unit": "Mbit/s", **about}
    yield {
        "figure": "replay_gap_p95",
        "value": round(1e3 * float(np.percentile(gaps, 95)), 1),
        "unit": "ms",
        **about,
    }
    late = {name: value - before.get(name, 0.0) for name, value in service.metrics().items()}
    looks = late["fev_event_loop_lag_seconds_count"]
    yield {
        "figure": "replay_loop_lag_below_20_ms",
        "value": round(100.0 * late['fev_event_loop_lag_seconds_bucket{le="0.02"}'] / looks, 2),
        "unit": "%",
        "floor": 99.0,
        "looks": int(looks),
        **about,
    }
    yield {
        "figure": "replay_ping_p99",
        "value": round(1e3 * lag.quantile(99.0), 1),
        "unit": "ms",
        "pings": len(lag.trips),
        **about,
    }


def _finished(run: str) -> Callable[[object], bool]:
    def test(event: object) -> bool:
        if isinstance(event, protocol.Error | protocol.Notice):
            raise RuntimeError(str(event))
        return (
            isinstance(event, protocol.RunChanged) and event.run.run == run and event.run.status == "finished"
        )

    return test
