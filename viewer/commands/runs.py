"""Services and runs: connecting, starting, choosing, pausing, comparing, recalculating."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = [
    "CompareWith",
    "ConnectTo",
    "DeleteRun",
    "MoveSwipe",
    "PauseRun",
    "PinRun",
    "Recalculate",
    "Reconnect",
    "ReleaseControl",
    "RenameRun",
    "ResumeRun",
    "SelectRun",
    "StartRun",
    "StopRun",
    "TakeControl",
    "UnpinRun",
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
    """Compute `case` from its start; None keeps the case's own duration and interval [s].

    Attributes:
        case: name of the case.
        duration: simulated time [s].
        output_interval: time between frames [s].
        device: "auto", "cpu" or "cuda:N".
        with_forcing: with the working forcing of the shown run, which is to be of the same case.
    """

    case: str
    duration: float | None = None
    output_interval: float | None = None
    device: str = "auto"
    with_forcing: bool = False


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
class RenameRun:
    """Give `run` (None: the run that is shown) a name for people; an empty one takes it away."""

    label: str
    run: str | None = None


@dataclass(frozen=True)
class PinRun:
    """Keep `run` (None: the run that is shown) whatever the budget of the store."""

    run: str | None = None


@dataclass(frozen=True)
class UnpinRun:
    """Let `run` (None: the run that is shown) go again when the store needs room."""

    run: str | None = None


@dataclass(frozen=True)
class DeleteRun:
    """Forget `run` (None: the run that is shown) and its frames."""

    run: str | None = None


@dataclass(frozen=True)
class TakeControl:
    """Control `run` (None: the run that is shown), by force also while another session is active."""

    run: str | None = None
    force: bool = False


@dataclass(frozen=True)
class ReleaseControl:
    """Give up the control of `run` (None: the run that is shown), to another session or to nobody."""

    run: str | None = None
    to: str | None = None


@dataclass(frozen=True)
class Recalculate:
    """Compute anew from the playback time on, with the working list of edits and the working forcing."""


RunCommand = (
    ConnectTo
    | Reconnect
    | StartRun
    | SelectRun
    | CompareWith
    | MoveSwipe
    | PauseRun
    | ResumeRun
    | StopRun
    | RenameRun
    | PinRun
    | UnpinRun
    | DeleteRun
    | TakeControl
    | ReleaseControl
    | Recalculate
)
"""Any command of this family."""
