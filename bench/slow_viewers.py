"""Does a slow, a stalled or a dead viewer, or a crowd of them, cost the run or a fast viewer anything?

One run of a lake that sloshes goes on all the time; a fast viewer follows it. Windows of equal length with
and without three slow viewers alternate (one that never reads, one at 10 frames/s, one over a link of
1 Mbit/s with 100 ms and stalls), in the order without, with, with, without, so that a drift cancels. A step
costs the same at all times, so the processor time of the worker a step tells whether viewers reach it. Then
dead viewers are timed until the service has let them go, and 64 followers watch.
"""

from __future__ import annotations

import tempfile
import time
from collections.abc import Iterator
from contextlib import nullcontext, suppress
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from typing import Any

import psutil

import protocol
from bench.crowd import Crowd, Viewer
from bench.loop_lag import LoopLag
from bench.service_process import ServiceClient, ServiceProcess
from bench.shaped_link import Link
from bench.slosh import write_slosh_case

SLOW_LINK = Link(bytes_per_s=125_000.0, delay_s=0.1, stall_every_s=3.0, stall_s=0.4)
FAST = Viewer("fast")
SLOW = [
    Viewer("dead", reads=False, credit=protocol.limits.MAX_CREDIT),
    Viewer("paced", frames_per_s=10.0, credit=1),
    Viewer("far", link=SLOW_LINK),
]
GONE_WITHIN_S = 30.0
DRAIN_S = 0.3


@dataclass(frozen=True)
class Size:
    """How much is measured.

    Attributes:
        side: cells of a side of the grid.
        pairs: windows with and without slow viewers.
        window_s: length of a window [s].
        followers: viewers that follow one run at the end.
        waits_for_the_dead: whether the end of a dead viewer is waited for.
    """

    side: int
    pairs: int
    window_s: float
    followers: int
    waits_for_the_dead: bool


FULL = Size(512, 10, 6.0, 64, True)
SMOKE = Size(192, 1, 1.0, 8, False)


def figures(smoke: bool) -> Iterator[dict[str, object]]:
    """What viewers cost a run, and what becomes of them."""
    size = SMOKE if smoke else FULL
    with tempfile.TemporaryDirectory(prefix="fev-viewers-") as folder:
        case = write_slosh_case(Path(folder) / "slosh", size.side, size.side, 1e6, 2.0)
        options: dict[str, Any] = {"threads": 1, "spare_workers": 0, "checkpoint_interval_s": 3600.0}
        with (
            ServiceProcess(Path(folder) / "data", cases=[str(case)], **options) as service,
            ServiceClient(service, grants_credit=False) as client,
        ):
            run = str(client.do(protocol.StartRun, case=str(case))["run"])
            client.do(protocol.Subscribe, run=run, credit=1)
            client.frame(run, 0)
            watch = Watch(service, client, run)
            with Crowd(service, run, [FAST]) as fast:
                yield from _slow_viewers(watch, size, fast)
            if size.waits_for_the_dead:
                yield from _dead_viewers(watch)
            yield from _followers(watch, size)
            client.do(protocol.StopRun, run=run)


class Watch:
    """One run that goes on, and what it costs."""

    def __init__(self, service: ServiceProcess, client: ServiceClient, run: str) -> None:
        self.service = service
        self.client = client
        self.run = run
        self.web = psutil.Process(service.process.pid)
        self.worker = max(self.web.children(), key=lambda child: sum(child.cpu_times()[:2]))

    def cpu_per_step(self, seconds: float) -> float:
        """Processor time of the worker a step, over so long from now [s]."""
        self.read(DRAIN_S)  # what was told since is old
        steps, cpu = self._now()
        self.read(seconds)
        steps_after, cpu_after = self._now()
        return (cpu_after - cpu) / (steps_after - steps)

    def read(self, seconds: float) -> None:
        """Take in what is told for so long."""
        with suppress(TimeoutError):
            self.client.until(lambda event: False, timeout_s=seconds)

    def _now(self) -> tuple[int, float]:
        """Steps so far, and the processor time of the worker when that was told [s]."""
        steps = self.client.first(protocol.Progress, lambda told: told.run == self.run).steps
        return steps, sum(self.worker.cpu_times()[:2])

    @property
    def memory(self) -> int:
        """Memory of the web process [bytes]."""
        return int(self.web.memory_info().rss)

    @property
    def publish_wait(self) -> dict[str, object]:
        """The longest wait of the worker to hand a frame over, as a figure."""
        waited_ms = 1e3 * float(self.service.status()["longest_publish_wait_s"])
        return {"value": round(waited_ms, 3), "unit": "ms", "floor": 1.0}

    def is_connected(self, session: str) -> bool:
        """Whether the service still holds the connection of a session."""
        return any(fact["session"] == session for fact in self.service.get("/v1/connections"))


def _slow_viewers(watch: Watch, size: Size, fast: Crowd) -> Iterator[dict[str, object]]:
    """Windows with and without slow viewers."""
    watch.cpu_per_step(size.window_s)  # the first numbers are those of a cold machine
    memory = [watch.memory]
    costs: dict[bool, list[float]] = {True: [], False: []}
    rates: dict[bool, list[float]] = {True: [], False: []}
    slow_rates: dict[str, list[float]] = {viewer.name: [] for viewer in SLOW}
    for pair in range(size.pairs):
        for slow in (False, True) if pair % 2 == 0 else (True, False):
            with Crowd(watch.service, watch.run, SLOW) if slow else nullcontext() as crowd:
                since = fast.counted()
                slow_since = crowd.counted() if crowd is not None else None
                costs[slow].append(watch.cpu_per_step(size.window_s))
                rates[slow].append(fast.rates_since(since)["fast"])
                if crowd is not None and slow_since is not None:
                    for name, rate in crowd.rates_since(slow_since).items():
                        slow_rates[name].append(rate)
                memory.append(watch.memory)
    about = {"pairs": size.pairs, "window_s": size.window_s, "cells": size.side**2}
    pairs = zip(costs[True], costs[False], strict=True)
    cost = median(with_slow / without for with_slow, without in pairs)
    yield {
        "figure": "cpu_per_step_with_to_without",
        "value": round(cost, 4),
        "unit": "1",
        "floor": 1.03,
        **about,
    }
    spread = median(abs(value / median(costs[False]) - 1.0) for value in costs[False])
    yield {"figure": "cpu_per_step_spread_without", "value": round(spread, 4), "unit": "1", **about}
    gain = median(a / b for a, b in zip(rates[True], rates[False], strict=True))
    yield {"figure": "fast_rate_with_to_without", "value": round(gain, 3), "unit": "1", **about}
    yield {"figure": "fast_rate", "value": round(median(rates[True]), 1), "unit": "frames/s", **about}
    for name, values in slow_rates.items():
        yield {"figure": f"{name}_rate", "value": round(median(values), 1), "unit": "frames/s", **about}
    growth = (max(memory) - memory[0]) / 1e6
    yield {"figure": "memory_growth", "value": round(growth, 1), "unit": "MB", "floor": 100.0, **about}
    yield {"figure": "longest_publish_wait_slow_viewers", **watch.publish_wait, **about}


def _dead_viewers(watch: Watch) -> Iterator[dict[str, object]]:
    """How long the service holds on to a viewer that has stopped reading, with and without a backlog."""
    viewers = [
        Viewer("dead_with_backlog", reads=False, credit=protocol.limits.MAX_CREDIT),
        Viewer("dead_and_idle", reads=False, credit=1),
    ]
    with Crowd(watch.service, watch.run, viewers) as crowd:
        begun = time.monotonic()
        held = dict(crowd.sessions)
        while held and time.monotonic() - begun < 2.0 * GONE_WITHIN_S:
            watch.read(0.25)
            for name, session in list(held.items()):
                if not watch.is_connected(session):
                    del held[name]
                    gone = round(time.monotonic() - begun, 1)
                    yield {"figure": f"{name}_gone_after", "value": gone, "unit": "s", "floor": GONE_WITHIN_S}
    if held:
        raise TimeoutError(f"{sorted(held)} were still connected after {2.0 * GONE_WITHIN_S:g} s")


def _followers(watch: Watch, size: Size) -> Iterator[dict[str, object]]:
    """Many viewers on one run, as fast as they can."""
    followers = [Viewer(f"follower{number}") for number in range(size.followers)]
    alone = watch.cpu_per_step(size.window_s)
    memory = watch.memory
    with Crowd(watch.service, watch.run, followers) as crowd, LoopLag(watch.service) as lag:
        since = crowd.counted()
        cost = watch.cpu_per_step(size.window_s)
        rates = sorted(crowd.rates_since(since).values())
        growth = (watch.memory - memory) / 1e6
    about = {"followers": size.followers, "cells": size.side**2}
    yield {"figure": "followers_slowest_rate", "value": round(rates[0], 1), "unit": "frames/s", **about}
    yield {"figure": "followers_fastest_rate", "value": round(rates[-1], 1), "unit": "frames/s", **about}
    yield {"figure": "followers_cpu_per_step_to_alone", "value": round(cost / alone, 4), "unit": "1", **about}
    yield {"figure": "followers_memory_growth", "value": round(growth, 1), "unit": "MB", **about}
    yield {"figure": "longest_publish_wait_followers", **watch.publish_wait, **about}
    trip = round(1e3 * lag.quantile(99.0), 1)
    yield {"figure": "followers_ping_p99", "value": trip, "unit": "ms", **about}
