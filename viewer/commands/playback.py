"""Playing: the clock of the viewer, which the service knows nothing of. Times are simulation times [s]."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["FollowLive", "Loop", "Pause", "Play", "Seek", "SetSpeed", "TogglePlay"]


@dataclass(frozen=True)
class Play:
    """Let the playback clock run."""


@dataclass(frozen=True)
class Pause:
    """Hold the playback clock; the run goes on computing."""


@dataclass(frozen=True)
class TogglePlay:
    """Play when the playback clock is held, hold it when it runs."""


@dataclass(frozen=True)
class Seek:
    """Show the water at `time` [s]; leaves follow-live."""

    time: float


@dataclass(frozen=True)
class SetSpeed:
    """Play at `factor` simulated seconds per wall second."""

    factor: float


@dataclass(frozen=True)
class Loop:
    """Begin again at the start when playing reaches the end (or stop doing so)."""

    on: bool = True


@dataclass(frozen=True)
class FollowLive:
    """Stay at the newest computed frame (or stop doing so)."""

    on: bool = True


PlaybackCommand = Play | Pause | TogglePlay | Seek | SetSpeed | Loop | FollowLive
"""Any command of this family."""
