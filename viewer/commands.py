"""Everything a user can ask of the viewer, as small frozen values.

Buttons, keys, tools, scripts and tests make these; `viewer.app` alone carries them out. Positions are map
coordinates in metres (x = east, y = north), times are simulation times in seconds.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from viewer.errors import ViewerError

__all__ = [
    "AddVertex",
    "BeginEdit",
    "CancelEdit",
    "ChangeEditSettings",
    "Command",
    "CommandError",
    "CompareWith",
    "DragOrbit",
    "DragPan",
    "FinishEdit",
    "FlyTo",
    "FollowLive",
    "GrabView",
    "HoldMove",
    "MoveHover",
    "Pause",
    "PauseRun",
    "Play",
    "ProbeAt",
    "Recalculate",
    "Redo",
    "ReleaseMoves",
    "ResetView",
    "ResumeRun",
    "SavePicture",
    "Seek",
    "SelectRun",
    "SetOption",
    "SetSpeed",
    "StartRun",
    "StopRun",
    "TogglePlay",
    "TopView",
    "Undo",
    "Zoom",
    "command_from_mapping",
]


class CommandError(ViewerError):
    """A command that cannot be made or carried out; the text says why in one sentence."""


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
class FollowLive:
    """Stay at the newest computed frame (or stop doing so)."""

    on: bool = True


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
    """Colour the picture by the difference to another run at the same time; None ends the comparison."""

    run: str | None = None


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
class ChangeEditSettings:
    """What the next edit will be; None leaves a setting as it is.

    Attributes:
        width: width of the line [m].
        magnitude: height of the change [m].
        operation: "raise" or "lower".
        type: "modulate" (add to the ground) or "replace" (a crest or a floor along the line).
    """

    width: float | None = None
    magnitude: float | None = None
    operation: str | None = None
    type: str | None = None


@dataclass(frozen=True)
class BeginEdit:
    """Start drawing an edit line; the edit tool is on until it is finished or cancelled."""


@dataclass(frozen=True)
class AddVertex:
    """Add the ground point (x, y) [m] to the line being drawn."""

    x: float
    y: float


@dataclass(frozen=True)
class MoveHover:
    """The pointer is over the ground point (x, y) [m], or over nothing; readout and rubber band follow."""

    x: float | None
    y: float | None


@dataclass(frozen=True)
class FinishEdit:
    """Take the drawn line into the list of edits."""


@dataclass(frozen=True)
class CancelEdit:
    """Drop the line being drawn and put the edit tool away."""


@dataclass(frozen=True)
class Undo:
    """Take back the newest edit of the working list."""


@dataclass(frozen=True)
class Redo:
    """Bring the edit taken back last."""


@dataclass(frozen=True)
class Recalculate:
    """Compute anew with the working list of edits from the playback time on."""


@dataclass(frozen=True)
class ProbeAt:
    """Keep a depth record at the ground point (x, y) [m]."""

    x: float
    y: float


@dataclass(frozen=True)
class SetOption:
    """Set a view option (see `viewer.render.ViewOptions`) by name."""

    name: str
    value: bool | float | str


@dataclass(frozen=True)
class GrabView:
    """The pointer has taken hold of the view (`on`) or let it go; let go, the camera coasts to rest."""

    on: bool


@dataclass(frozen=True)
class DragOrbit:
    """Turn the camera about its target by a drag of (dx, dy) picture heights (x right, y down)."""

    dx: float
    dy: float


@dataclass(frozen=True)
class DragPan:
    """Move the ground by a drag of (dx, dy) picture heights (x right, y down)."""

    dx: float
    dy: float


@dataclass(frozen=True)
class Zoom:
    """Come nearer by `steps` wheel notches (negative: go away).

    The ground point (x, y) [m] keeps its place in the picture; None: the point looked at does.
    """

    steps: float
    x: float | None = None
    y: float | None = None


@dataclass(frozen=True)
class HoldMove:
    """A motion key went down (`on`) or up; `move` is the lower-case name of a `viewer.world.Move`."""

    move: str
    on: bool


@dataclass(frozen=True)
class ReleaseMoves:
    """No motion key is held any more: the window lost the keyboard."""


@dataclass(frozen=True)
class FlyTo:
    """Glide to look at (x, y) [m] from `distance` [m], in `seconds` of wall time (0: be there at once).

    `azimuth` and `elevation` are in degrees. Azimuth is the compass bearing in which the camera looks (0 =
    to the north, 90 = to the east), elevation
    the height of the eye above the horizon; None keeps the present value.
    """

    x: float
    y: float
    distance: float | None = None
    azimuth: float | None = None
    elevation: float | None = None
    seconds: float = 1.0


@dataclass(frozen=True)
class ResetView:
    """Show the whole terrain from the south."""


@dataclass(frozen=True)
class TopView:
    """Show the whole terrain from straight above, north up."""


@dataclass(frozen=True)
class SavePicture:
    """Write the picture now shown to `path` (PNG)."""

    path: str


Command = (
    Play
    | Pause
    | TogglePlay
    | Seek
    | SetSpeed
    | FollowLive
    | StartRun
    | SelectRun
    | CompareWith
    | PauseRun
    | ResumeRun
    | StopRun
    | ChangeEditSettings
    | BeginEdit
    | AddVertex
    | MoveHover
    | FinishEdit
    | CancelEdit
    | Undo
    | Redo
    | Recalculate
    | ProbeAt
    | SetOption
    | GrabView
    | DragOrbit
    | DragPan
    | Zoom
    | HoldMove
    | ReleaseMoves
    | FlyTo
    | ResetView
    | TopView
    | SavePicture
)

_BY_NAME: dict[str, type[Any]] = {kind.__name__: kind for kind in Command.__args__}


def command_from_mapping(entry: Mapping[str, Any]) -> Command:
    """Return the command that a script entry such as `{"command": "Seek", "time": 120.0}` names.

    Raises:
        CommandError: an unknown command, an unknown, missing or ill-typed argument, or a number that is not
            finite.
    """
    name = entry.get("command")
    kind = _BY_NAME.get(name) if isinstance(name, str) else None
    if kind is None:
        raise CommandError(f"command {name!r} is unknown; known are {', '.join(sorted(_BY_NAME))}")
    arguments = {key: value for key, value in entry.items() if key != "command"}
    fields = {field.name: field for field in dataclasses.fields(kind)}
    for key, value in arguments.items():
        if key not in fields:
            raise CommandError(
                f"{name}: argument {key!r} is unknown; allowed are {', '.join(fields) or 'none'}"
            )
        arguments[key] = _checked(f"{name}.{key}", value, str(fields[key].type))
    missing = [
        field.name
        for field in fields.values()
        if field.default is dataclasses.MISSING and field.name not in arguments
    ]
    if missing:
        raise CommandError(f"{name}: argument {missing[0]!r} is missing")
    command: Command = kind(**arguments)
    return command


def _checked(where: str, value: Any, annotation: str) -> Any:
    allowed = [part.strip() for part in annotation.split("|")]
    if value is None and "None" in allowed:
        return None
    if isinstance(value, bool):
        if "bool" in allowed:
            return value
    elif isinstance(value, (int, float)):
        if "float" in allowed and math.isfinite(value):
            return float(value)
    elif isinstance(value, str) and "str" in allowed:
        return value
    raise CommandError(f"{where} = {value!r} is not allowed; it must be {annotation} and finite")
