"""How fine the scene is drawn so that pictures keep pace: less where they take long, more again where not."""

from __future__ import annotations

from collections import deque

__all__ = ["SCALES", "PicturePace"]

SCALES = (1.0, 0.85, 0.75, 0.65, 0.55, 0.45)
"""Pixels of the scene for each pixel of the picture, along one side."""
SLOW_MS = 85.0
"""Pictures that take longer make the next ones coarser [ms]; a tenth of a second is felt as a jerk."""
FAST_MS = 45.0
"""Pictures that take less may become finer [ms]; the next finer scale costs up to a half more."""
SLOW_PICTURES = 3
FAST_PICTURES = 20
PATIENCE = 200
"""Pictures after which a scale that was too slow is tried again."""


class PicturePace:
    """Chooses the scale of the scene from what the last pictures took.

    One slow picture changes nothing: an upload or another program may have caused it.

    Args:
        start: scale to begin with, one of `SCALES`.
    """

    def __init__(self, start: float = 1.0) -> None:
        self._at = SCALES.index(start)
        self._taken: deque[float] = deque(maxlen=FAST_PICTURES)
        self._too_slow: int | None = None
        self._patience = 0

    @property
    def scale(self) -> float:
        """The scale for the next picture."""
        return SCALES[self._at]

    def note(self, milliseconds: float) -> None:
        """Take what a picture at this scale took [ms]."""
        self._taken.append(milliseconds)
        self._patience = max(0, self._patience - 1)
        last = list(self._taken)[-SLOW_PICTURES:]
        if len(last) == SLOW_PICTURES and min(last) > SLOW_MS and self._at < len(SCALES) - 1:
            self._too_slow, self._patience = self._at, PATIENCE
            self._move(1)
            return
        is_fast = len(self._taken) == FAST_PICTURES and max(self._taken) < FAST_MS
        if is_fast and self._at > 0 and (self._at - 1 != self._too_slow or self._patience == 0):
            self._move(-1)

    def _move(self, by: int) -> None:
        self._at += by
        self._taken.clear()
