"""Services and runs: connecting, starting, choosing, pausing, comparing, recalculating."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = [
    "CompareWith",
    "ConnectTo",
    "MoveSwipe",
    "PauseRun",
    "Recalculate",
    "Reconnect",
    "ResumeRun",
    "SelectRun",
    "StartRun",
    "StopRun",
]


@dataclass(frozen=True)
class ConnectTo:
    """Leave the service and look at another one.

    Attributes:
        url: its address, ws://HOST:PORT.
        token_file: file with the token for it, None when it asks for none.
    """

    url: str
    token_file: str | None = None


@dataclass(frozen=True)
class Reconnect:
    """Try to connect now rather than when the countdown ends."""


@dataclass(frozen=True)
class StartRun:
    """Compute `case` from its start; None keeps the case's own duration and interval [s]."""

    case: str
    duration: float | None = None
    output_interval: float | None = None
    device: str = "auto"


@dataclass(frozen=True)
class SelectRun:
    """Show another run of the service."""

    run: str


@dataclass(frozen=True)
class CompareWith:
    """Compare with another run at the same time; None ends the comparison.

    `mode` "difference" colours the picture by how much deeper or shallower the water is than there, "swipe"
    shows the other run right of a divider.
    """

    run: str | None = None
    mode: str = "difference"


@dataclass(frozen=True)
class MoveSwipe:
    """Put the divider between two runs at `at`, a share of the picture's width from the left."""

    at: float


@dataclass(frozen=True)
class PauseRun:
    """Hold the computation of `run` (None: the run that is shown)."""

    run: str | None = None


@dataclass(frozen=True)
class ResumeRun:
    """Let the computation of `run` go on (None: the run that is shown)."""

    run: str | None = None


@dataclass(frozen=True)
class StopRun:
    """End the computation of `run` (None: the run that is shown); its frames stay."""

    run: str | None = None


@dataclass(frozen=True)
class Recalculate:
    """Compute anew with the working list of edits from the playback time on."""
