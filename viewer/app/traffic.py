"""How much comes in from the service a second."""

from __future__ import annotations

import dataclasses

from viewer.app.service_desk import ServiceDesk
from viewer.view_status import ViewStatus

__all__ = ["Traffic"]

SPAN_S = 1.0
"""Time over which the rate is averaged [s]."""


class Traffic:
    """Turns a counter of bytes into a rate."""

    def __init__(self) -> None:
        self._since: tuple[float, int] | None = None
        self.rate = 0.0

    def report(self, status: ViewStatus, desk: ServiceDesk, now: float) -> ViewStatus:
        """Return `status` with what comes in and how old it is, at wall time `now` [s, monotonic]."""
        received, age = desk.connection.received_bytes, desk.data_age(now)
        return dataclasses.replace(
            status,
            received_bytes=received,
            received_bit_s=self.note(received, now),
            data_age=None if age is None else float(int(age)),  # whole seconds: one new status a second
        )

    def note(self, received: int, now: float) -> float:
        """Take a reading and return the rate [bit/s] of the last whole span.

        Args:
            received: bytes received so far.
            now: wall time [s, monotonic].
        """
        if self._since is None or received < self._since[1]:
            self._since = (now, received)
        span = now - self._since[0]
        if span >= SPAN_S:
            self.rate = 8.0 * (received - self._since[1]) / span
            self._since = (now, received)
        return self.rate
