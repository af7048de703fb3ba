"""Notices workers that hang without dying, and ends them; what follows is what follows any death.

A worker sends a pulse each second from a thread of its own, with the number of times that its solver thread
has looked for commands: between two steps, and between two orders. That proves two things.

- No pulse: no thread of the process runs. It was stopped, is frozen, or a library holds the interpreter's
  lock. A step or a compilation, however long, does not hold it.
- Pulses, but the number stands although the solver thread does not wait for an order: one step, one
  compilation, one case that is loaded, or one write takes so long. Whether it would ever end nobody can know,
  so the patience is long, and a worker that is still starting (it compiles its kernels) has no end to it.
"""

from __future__ import annotations

import asyncio
import logging
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Protocol

from solver_service.runs.worker_failure import FailureKind

LOG = logging.getLogger(__name__)

INTERVAL_S = 1.0
LATE_S = 1.0
"""A look that comes so late says that the watcher itself was held up; it then believes nothing it sees."""


@dataclass(frozen=True)
class Patience:
    """How long a worker may show nothing.

    Attributes:
        silence_s: without a pulse [s].
        stall_s: with pulses, but at one and the same thing [s].
        start_s: from the start of the process to its first pulse [s].
    """

    silence_s: float = 30.0
    stall_s: float = 600.0
    start_s: float = 120.0


class Watched(Protocol):
    """A worker as the watch sees it.

    Attributes:
        pulse_at: when the last pulse came, or the process was started [s].
        advanced_at: when its solver thread was last seen to go on, or to wait for orders [s].
        has_pulse: whether a pulse ever came.
        is_ready: whether it takes orders.
    """

    pulse_at: float
    advanced_at: float
    has_pulse: bool

    @property
    def is_ready(self) -> bool:
        """Whether it takes orders."""

    def give_up(self, kind: FailureKind, words: str) -> None:
        """End it at once, for a reason."""


class WorkerWatch:
    """Looks at all workers again and again."""

    def __init__(
        self,
        workers: Callable[[], Iterable[Watched]],
        patience: Patience,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        """Watch workers.

        Args:
            workers: gives those that live.
            patience: how long they may show nothing.
            clock: gives the time now [s].
        """
        self._workers = workers
        self._patience = patience
        self._clock = clock
        self._looked_at = clock()

    async def work(self) -> None:
        """Look at intervals; ends only by being cancelled."""
        interval = min(INTERVAL_S, self._patience.silence_s / 4)
        self._looked_at = self._clock()
        while True:
            await asyncio.sleep(interval)
            self.look(interval)

    def look(self, interval_s: float = INTERVAL_S) -> None:
        """Look once, so many seconds after the last time."""
        now = self._clock()
        was_held_up = now - self._looked_at > interval_s + LATE_S
        self._looked_at = now
        for worker in tuple(self._workers()):
            if was_held_up:  # pulses wait in the pipes and are not heard yet
                worker.pulse_at = worker.advanced_at = now
            elif (words := self._verdict(worker, now)) is not None:
                worker.give_up(FailureKind.HUNG, words)

    def _verdict(self, worker: Watched, now: float) -> str | None:
        silent_s, stalled_s = now - worker.pulse_at, now - worker.advanced_at
        if silent_s > (self._patience.silence_s if worker.has_pulse else self._patience.start_s):
            return f"its worker process gave no sign for {silent_s:.0f} s and was ended"
        if worker.is_ready and stalled_s > self._patience.stall_s:
            return f"its worker did one and the same thing for {stalled_s:.0f} s and was ended"
        return None
