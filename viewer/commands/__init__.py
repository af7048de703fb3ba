"""Everything a user can ask of the viewer, as small frozen values.

Buttons, keys, tools, scripts and tests make these; `viewer.app` alone carries them out. Positions are map
coordinates in metres (x = east, y = north), times are simulation times in seconds.
"""

from viewer.commands.camera import (
    DragOrbit,
    DragPan,
    FlyTo,
    GrabView,
    HoldMove,
    ReleaseMoves,
    ResetView,
    TopView,
    Zoom,
)
from viewer.commands.command import Command, CommandError
from viewer.commands.edits import (
    AddVertex,
    BeginEdit,
    CancelEdit,
    ChangeEditSettings,
    FinishEdit,
    Redo,
    Undo,
)
from viewer.commands.mapping import command_from_mapping
from viewer.commands.picture import (
    MoveHover,
    ProbeAt,
    SavePicture,
    SetOption,
)
from viewer.commands.playback import (
    FollowLive,
    Pause,
    Play,
    Seek,
    SetSpeed,
    TogglePlay,
)
from viewer.commands.runs import (
    CompareWith,
    ConnectTo,
    PauseRun,
    Recalculate,
    Reconnect,
    ResumeRun,
    SelectRun,
    StartRun,
    StopRun,
)

__all__ = [
    "AddVertex",
    "BeginEdit",
    "CancelEdit",
    "ChangeEditSettings",
    "Command",
    "CommandError",
    "CompareWith",
    "ConnectTo",
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
    "Reconnect",
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
