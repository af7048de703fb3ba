"""Which frames share a scale and a key frame: the same however often the computation was interrupted.

A group begins at the first frame of a run, after `limits.FRAME_GROUP` frames, and where the water no longer
fits the scale. The frames of a run that is taken up again go on with the group that is open in the store, so
that their bytes are those of a run that nothing disturbed.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from protocol import Frame, choose_depth_scale, limits, peek_frame
from solver_service.store import FrameReader, FrameRecord, RunDatabase

Q_FULL = 65535
"""A depth at the end of its scale: the frame is quantised again on a coarser one."""

Quantise = Callable[[float], tuple[NDArray[np.uint16], NDArray[np.uint8]]]


@dataclass
class FrameGrouping:
    """The group that is open.

    Attributes:
        scale: depth of one unit [m].
        end: index at which the next group begins.
    """

    scale: float = 0.0
    end: int = -1

    def quantise(
        self, index: int, quantise: Quantise, depth_max: Callable[[], float]
    ) -> tuple[NDArray[np.uint16], NDArray[np.uint8], float]:
        """Quantise the water of a frame on the scale of its group, or begin a group with it.

        Args:
            index: frame index.
            quantise: gives q and block states for a scale [m].
            depth_max: gives the greatest depth [m].

        Returns:
            q, block states, and the scale [m].
        """
        if index >= self.end:
            self._begin(index, depth_max())
        q, states = quantise(self.scale)
        if q.max(initial=0) == Q_FULL:
            self._begin(index, depth_max())
            q, states = quantise(self.scale)
        return q, states, self.scale

    def _begin(self, index: int, depth: float) -> None:
        self.scale, self.end = choose_depth_scale(depth), index + limits.FRAME_GROUP


def open_key_frame(database: RunDatabase, reader: FrameReader, run: str) -> Frame | None:
    """The key frame on which the next frame of a run may lean; None where a group begins.

    Raises:
        StoreError: it is damaged.
    """
    last = database.last_frame(run)
    if last is None or last.index + 1 >= last.key_index + limits.FRAME_GROUP:
        return None
    key: FrameRecord | None = last if last.is_key else database.frame(run, last.key_index)
    return None if key is None else peek_frame(reader.read(key))


def grouping_after(key: Frame | None) -> FrameGrouping:
    """The grouping that goes on after a key frame, or begins anew."""
    return FrameGrouping() if key is None else FrameGrouping(key.scale, key.index + limits.FRAME_GROUP)
