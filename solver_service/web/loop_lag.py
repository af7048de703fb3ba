"""How late the event loop is: everything that a viewer waits for waits at least so long."""

from __future__ import annotations

import asyncio
import time

from prometheus_client import CollectorRegistry, Histogram

INTERVAL_S = 0.05
BUCKETS_S = (0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0)


class LoopLag:
    """Sleeps for a short time again and again, and keeps how much longer each sleep took."""

    def __init__(self, registry: CollectorRegistry) -> None:
        """Tell the lag as `fev_event_loop_lag_seconds` of a registry of metrics."""
        self._histogram = Histogram(
            "fev_event_loop_lag_seconds",
            "How much later than asked the event loop went on, looked at 20 times a second.",
            registry=registry,
            buckets=BUCKETS_S,
        )

    async def work(self, interval_s: float = INTERVAL_S) -> None:
        """Look again and again; ends only by being cancelled."""
        while True:
            due = time.perf_counter() + interval_s
            await asyncio.sleep(interval_s)
            self._histogram.observe(max(time.perf_counter() - due, 0.0))
