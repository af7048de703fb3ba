"""Which frames are at hand, and which two of them bracket a playback time."""

from __future__ import annotations

from bisect import bisect_right, insort
from dataclasses import dataclass

__all__ = ["Bracket", "WaterTimeline"]


@dataclass(frozen=True)
class Bracket:
    """Two frames around a time: depth = (1 - alpha) h[first] + alpha h[second]."""

    first: int
    second: int
    alpha: float


class WaterTimeline:
    """The indices of frames that can be shown, in order; frame k has the time k x interval."""

    def __init__(self, interval: float) -> None:
        """Begin with no frame.

        Args:
            interval: time between frames [s], > 0.
        """
        if not interval > 0.0:
            raise ValueError(f"output interval {interval!r} must be > 0 s")
        self.interval = float(interval)
        self._indices: list[int] = []

    def __len__(self) -> int:
        """How many frames are at hand."""
        return len(self._indices)

    def __contains__(self, index: int) -> bool:
        """Whether a frame is at hand."""
        place = bisect_right(self._indices, index)
        return place > 0 and self._indices[place - 1] == index

    @property
    def indices(self) -> tuple[int, ...]:
        """All frames at hand, in order."""
        return tuple(self._indices)

    @property
    def first_time(self) -> float:
        """Time of the earliest frame [s]; 0 if there is none."""
        return self._indices[0] * self.interval if self._indices else 0.0

    @property
    def last_time(self) -> float:
        """Time of the latest frame [s]; 0 if there is none."""
        return self._indices[-1] * self.interval if self._indices else 0.0

    def time_of(self, index: int) -> float:
        """Time of a frame [s]."""
        return index * self.interval

    def index_before(self, time: float) -> int:
        """Index of the last frame time at or before a time, whether at hand or not."""
        # A clock that stands on a frame time must find that frame in spite of rounding.
        return max(0, int(time / self.interval + 1e-9))

    def add(self, index: int) -> None:
        """Note that a frame is at hand."""
        if index not in self:
            insort(self._indices, index)

    def discard(self, index: int) -> None:
        """Note that a frame is no longer at hand."""
        if index in self:
            self._indices.remove(index)

    def drop_from(self, index: int) -> None:
        """Forget every frame from an index on: a recalculated run has another future."""
        del self._indices[bisect_right(self._indices, index - 1) :]

    def bracket(self, time: float) -> Bracket | None:
        """The nearest frames at hand at or before, and after, a time; None if there is no frame at all.

        Before the first and after the last frame both are the same one and alpha is 0.
        """
        if not self._indices:
            return None
        after = bisect_right(self._indices, time / self.interval + 1e-9)
        if after == 0:
            return Bracket(self._indices[0], self._indices[0], 0.0)
        if after == len(self._indices):
            return Bracket(self._indices[-1], self._indices[-1], 0.0)
        first, second = self._indices[after - 1], self._indices[after]
        alpha = (time / self.interval - first) / (second - first)
        return Bracket(first, second, min(max(alpha, 0.0), 1.0))
