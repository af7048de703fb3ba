"""How often a run whose worker died is taken up again before a person must look at it."""

from __future__ import annotations

import time
from collections import defaultdict, deque
from collections.abc import Callable

from solver_service.runs.worker_failure import RETRIED, FailureKind


class RestartPolicy:
    """At most so many restarts of a run within a time; never after a failure that would come again."""

    def __init__(
        self, attempts: int = 3, within_s: float = 600.0, clock: Callable[[], float] = time.monotonic
    ) -> None:
        """A policy without a past.

        Args:
            attempts: restarts of one run within the time; 0 for none.
            within_s: the time [s].
            clock: gives the time now [s].
        """
        self.attempts = attempts
        self.within_s = within_s
        self._clock = clock
        self._restarts: dict[str, deque[float]] = defaultdict(deque)

    def grant(self, run: str, kind: FailureKind) -> int:
        """Allow one more restart, or not.

        Args:
            run: the run.
            kind: why its worker is gone.

        Returns:
            The number of the attempt within the time, from 1; 0 when it is refused.
        """
        if kind not in RETRIED:
            return 0
        now = self._clock()
        past = self._restarts[run]
        while past and now - past[0] > self.within_s:
            past.popleft()
        if len(past) >= self.attempts:
            return 0
        past.append(now)
        return len(past)

    def forget(self, run: str) -> None:
        """A person took the run up again, or it is gone."""
        self._restarts.pop(run, None)
