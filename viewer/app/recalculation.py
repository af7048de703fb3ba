"""One Recalculate from the press of the button to its changed frames on the picture."""

from __future__ import annotations

from dataclasses import dataclass

import protocol

__all__ = ["Recalculation"]


@dataclass
class Recalculation:
    """What is known of a recalculation.

    Attributes:
        parent: run that was shown when it was asked for.
        index: frame index it starts at.
        edits: the working list it was asked for with.
        pressed_at: wall time of the press [s, monotonic].
        follows_live: whether playback followed the newest frame.
        child: the run that computes it, once the service has named it.
        first_frame_s: from the press to its first frame (the edited bed and water at the branch time) on the
            picture [s].
        next_frame_s: from the press to the frame after that, the first one computed on the edited bed [s].
    """

    parent: str
    index: int
    edits: tuple[protocol.Edit, ...]
    pressed_at: float
    follows_live: bool
    child: str | None = None
    first_frame_s: float | None = None
    next_frame_s: float | None = None

    @property
    def is_waiting(self) -> bool:
        """Whether no frame of it has been on the picture yet."""
        return self.first_frame_s is None

    def note_painted(self, frames: tuple[tuple[str, int], ...], now: float) -> bool:
        """Note the frames on the picture at wall time `now`; return whether that told anything new."""
        if self.child is None:
            return False
        told = False
        of_child = [index for run, index in frames if run == self.child]
        if of_child and self.first_frame_s is None:
            self.first_frame_s = now - self.pressed_at
            told = True
        if any(index > self.index for index in of_child) and self.next_frame_s is None:
            self.next_frame_s = now - self.pressed_at
            told = True
        return told
