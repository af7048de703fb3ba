"""The union of all commands: what `viewer.app` can carry out."""

from __future__ import annotations

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
from viewer.commands.edits import (
    AddVertex,
    BeginEdit,
    BeginLevelPick,
    BeginSelect,
    CancelEdit,
    ChangeEdit,
    ChangeEditSettings,
    DeleteEdit,
    DragEdit,
    DropEdit,
    DropVertex,
    EndStroke,
    FinishEdit,
    GrabEdit,
    LoadEdits,
    MoveEdit,
    MoveVertex,
    Redo,
    RenameEdit,
    SaveEdits,
    SelectEdit,
    StrokeTo,
    TakeLevel,
    Undo,
)
from viewer.commands.forcing import ChangeForcing, ResetForcing
from viewer.commands.measuring import AddMeasurePoint, BeginMeasure, EndMeasure
from viewer.commands.picture import (
    MoveHover,
    ProbeAt,
    SavePicture,
    SetOption,
    ShowSeries,
)
from viewer.commands.playback import (
    FollowLive,
    Loop,
    Pause,
    Play,
    Seek,
    SetSpeed,
    TogglePlay,
)
from viewer.commands.presenting import FollowView, PresentView
from viewer.commands.runs import (
    CompareWith,
    ConnectTo,
    DeleteRun,
    MoveSwipe,
    PauseRun,
    PinRun,
    Recalculate,
    Reconnect,
    ReleaseControl,
    RenameRun,
    ResumeRun,
    SelectRun,
    StartRun,
    StopRun,
    TakeControl,
    UnpinRun,
)
from viewer.errors import ViewerError

__all__ = ["Command", "CommandError"]


class CommandError(ViewerError):
    """A command that cannot be made or carried out; the text says why in one sentence."""


Command = (
    Play
    | Pause
    | TogglePlay
    | Seek
    | SetSpeed
    | FollowLive
    | Loop
    | BeginMeasure
    | AddMeasurePoint
    | EndMeasure
    | PresentView
    | FollowView
    | ConnectTo
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
    | ChangeForcing
    | ResetForcing
    | Recalculate
    | ChangeEditSettings
    | BeginEdit
    | AddVertex
    | DropVertex
    | StrokeTo
    | EndStroke
    | FinishEdit
    | CancelEdit
    | BeginSelect
    | SelectEdit
    | GrabEdit
    | DragEdit
    | DropEdit
    | MoveEdit
    | MoveVertex
    | ChangeEdit
    | RenameEdit
    | DeleteEdit
    | BeginLevelPick
    | TakeLevel
    | SaveEdits
    | LoadEdits
    | Undo
    | Redo
    | GrabView
    | DragOrbit
    | DragPan
    | Zoom
    | HoldMove
    | ReleaseMoves
    | FlyTo
    | ResetView
    | TopView
    | MoveHover
    | ProbeAt
    | SetOption
    | ShowSeries
    | SavePicture
)
"""Any command."""
