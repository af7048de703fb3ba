"""Terrain edits: the tools, what is being drawn, the working list. Positions are map coordinates [m]."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = [
    "AddVertex",
    "BeginEdit",
    "BeginLevelPick",
    "BeginSelect",
    "CancelEdit",
    "ChangeEdit",
    "ChangeEditSettings",
    "DeleteEdit",
    "DragEdit",
    "DropEdit",
    "DropVertex",
    "EndStroke",
    "FinishEdit",
    "GrabEdit",
    "LoadEdits",
    "MoveEdit",
    "MoveVertex",
    "Redo",
    "RenameEdit",
    "SaveEdits",
    "SelectEdit",
    "StrokeTo",
    "TakeLevel",
    "Undo",
]


@dataclass(frozen=True)
class ChangeEditSettings:
    """What the next edit will be; None leaves a setting as it is.

    Attributes:
        width: width of the line [m].
        magnitude: height of the change [m].
        operation: "raise" or "lower".
        type: "modulate" (add to the ground) or "replace" (a crest or a floor along the line).
        level: elevation of the crest or floor [m], for "replace" with `at_level`.
        at_level: whether "replace" means that elevation, not the magnitude above the ground.
    """

    width: float | None = None
    magnitude: float | None = None
    operation: str | None = None
    type: str | None = None
    level: float | None = None
    at_level: bool | None = None


@dataclass(frozen=True)
class ChangeEdit(ChangeEditSettings):
    """Change an edit of the working list; None leaves a setting as it is.

    Attributes:
        edit: its id; None for the selected one.
    """

    edit: str | None = None


@dataclass(frozen=True)
class BeginEdit:
    """Start drawing an edit, `kind` "line" or "area"; the tool is on until it is finished or cancelled."""

    kind: str = "line"


@dataclass(frozen=True)
class AddVertex:
    """Add the ground point (x, y) [m] to the edit being drawn; an area is closed on its first point."""

    x: float
    y: float


@dataclass(frozen=True)
class DropVertex:
    """Take the last point of the edit being drawn off again."""


@dataclass(frozen=True)
class StrokeTo:
    """Draw free-hand to the ground point (x, y) [m]."""

    x: float
    y: float


@dataclass(frozen=True)
class EndStroke:
    """The free-hand stroke is over: its points are thinned out to those that give it its shape."""


@dataclass(frozen=True)
class FinishEdit:
    """Take what is drawn into the list of edits."""


@dataclass(frozen=True)
class CancelEdit:
    """Drop what is being drawn or moved and put the tool away."""


@dataclass(frozen=True)
class BeginSelect:
    """Take the tool that selects and moves edits on the picture."""


@dataclass(frozen=True)
class SelectEdit:
    """Select an edit of the working list by its id; None selects none."""

    edit: str | None = None


@dataclass(frozen=True)
class GrabEdit:
    """Take hold of the edit at the ground point (x, y) [m] and select it; a vertex when one is near."""

    x: float
    y: float


@dataclass(frozen=True)
class DragEdit:
    """Move what was taken hold of to the ground point (x, y) [m]."""

    x: float
    y: float


@dataclass(frozen=True)
class DropEdit:
    """Leave what was moved where it is: the working list takes it over."""


@dataclass(frozen=True)
class MoveEdit:
    """Move an edit by (dx, dy) [m], no farther than the terrain goes; None for the selected one."""

    dx: float
    dy: float
    edit: str | None = None


@dataclass(frozen=True)
class MoveVertex:
    """Move vertex number `vertex` (from 0) of an edit to (x, y) [m]; None for the selected edit."""

    vertex: int
    x: float
    y: float
    edit: str | None = None


@dataclass(frozen=True)
class RenameEdit:
    """Give an edit a name, an empty one takes it away; None for the selected edit."""

    name: str
    edit: str | None = None


@dataclass(frozen=True)
class DeleteEdit:
    """Take an edit out of the working list; None for the selected one."""

    edit: str | None = None


@dataclass(frozen=True)
class BeginLevelPick:
    """Let the next click on the picture say the level of the crest: `TakeLevel`."""


@dataclass(frozen=True)
class TakeLevel:
    """Take the water level at (x, y) [m], or the ground where it is dry, as the level of the crest."""

    x: float
    y: float


@dataclass(frozen=True)
class SaveEdits:
    """Write the working list to a GeoJSON file."""

    path: str


@dataclass(frozen=True)
class LoadEdits:
    """Add the edits of a GeoJSON file to the working list."""

    path: str


@dataclass(frozen=True)
class Undo:
    """Take back the newest change of the working list."""


@dataclass(frozen=True)
class Redo:
    """Make the change taken back last again."""


EditToolCommand = (
    BeginEdit
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
    | BeginLevelPick
    | TakeLevel
)
"""What the tools in the hand do: draw, select, move, take a level."""


EditListCommand = (
    ChangeEdit | MoveEdit | MoveVertex | RenameEdit | DeleteEdit | SaveEdits | LoadEdits | Undo | Redo
)
"""What changes the working list, or carries it to and from files."""

EditCommand = ChangeEditSettings | EditToolCommand | EditListCommand
"""Any command about edits."""
