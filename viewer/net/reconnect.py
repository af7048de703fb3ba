"""When to try again after a lost connection: exponential back-off with jitter."""

from __future__ import annotations

import random
from dataclasses import dataclass, field

__all__ = ["BackOff"]


@dataclass
class BackOff:
    """Waiting times between attempts: `first_s`, doubled each time up to `longest_s`, less a random share.

    The random share (up to `jitter` of the time) keeps many viewers from coming back in one instant.
    """

    first_s: float = 0.5
    longest_s: float = 15.0
    jitter: float = 0.3
    attempt: int = 0
    source: random.Random = field(default_factory=random.Random)

    def next_delay(self) -> float:
        """Count one more attempt and return how long to wait before it [s]."""
        delay = min(self.first_s * 2.0**self.attempt, self.longest_s)
        self.attempt += 1
        return delay * (1.0 - self.jitter * self.source.random())

    def reset(self) -> None:
        """Start over: the connection stands."""
        self.attempt = 0
