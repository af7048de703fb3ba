"""The edit tools: draw, select, move, take a level; what comes of it goes to the working list."""

from __future__ import annotations

from collections.abc import Callable

import protocol
from viewer.app.edit_drawing import EditDrawing, changed_settings
from viewer.app.edit_list import EditList
from viewer.app.edit_selection import EditSelection
from viewer.app.service_desk import ServiceDesk
from viewer.app.shown_run import ShownRun
from viewer.commands import (
    AddVertex,
    BeginEdit,
    BeginLevelPick,
    BeginSelect,
    CancelEdit,
    ChangeEdit,
    ChangeEditSettings,
    Command,
    CommandError,
    DragEdit,
    DropEdit,
    DropVertex,
    EndStroke,
    FinishEdit,
    GrabEdit,
    SelectEdit,
    StrokeTo,
    TakeLevel,
)
from viewer.commands.edits import EditToolCommand
from viewer.view_status import PointReadout

__all__ = ["Editing"]

GroundAt = Callable[[float, float], float]


class Editing:
    """The edit tools with the run they edit.

    Args:
        desk: the dealings with the service.
        say: shows a sentence to the user.

    Attributes:
        list: the changes of the working list.
        drawing: what is being drawn.
        selection: what is selected and moved.
        picks_level: whether the next click says the level of the crest.
        reach: how near on the ground a click is near enough now [m].
        look: what water and ground are at a point.
    """

    def __init__(self, desk: ServiceDesk, say: Callable[[str], None]) -> None:
        self._say = say
        self._ground: GroundAt | None = None
        self.list = EditList(desk, say)
        self.list.answered = self.refresh
        self.drawing = EditDrawing()
        self.selection = EditSelection()
        self.picks_level = False
        self.reach: Callable[[], float] = lambda: 0.0
        self.look: Callable[[float, float], PointReadout | None] = lambda _x, _y: None

    @property
    def tool(self) -> str:
        """The tool in hand: "line", "area", "select", "level", or empty."""
        if self.picks_level:
            return "level"
        if self.drawing.is_on:
            return self.drawing.kind
        return "select" if self.selection.is_on else ""

    def carry_out(self, command: Command, shown: ShownRun | None) -> bool:
        """Carry out an edit command; return False when it is none.

        Raises:
            CommandError: it makes no sense now.
            EditError: an edit does not fit the terrain.
            EditFileError: a file cannot be read or written.
        """
        if isinstance(command, ChangeEditSettings) and not isinstance(command, ChangeEdit):
            self.drawing.settings = changed_settings(self.drawing.settings, command)
            self.refresh(shown)
            return True
        if not (isinstance(command, EditToolCommand) or self.list.knows(command)):
            return False
        if shown is None:
            raise CommandError("no run is shown yet")
        if not (self._draw(command, shown) or self._pick(command, shown)):
            self.list.carry_out(command, shown, self.selection.selected, self.drawing.settings)
        self.refresh(shown)
        return True

    def hover(self, at: tuple[float, float] | None, shown: ShownRun | None) -> None:
        """Let the rubber band end at `at`."""
        if self.drawing.is_on and shown is not None:
            self.drawing.hover = at if at is not None and shown.grid.contains(*at) else None
            self.refresh(shown)

    def reset(self) -> None:
        """Another run is shown: nothing is being drawn or moved."""
        self._put_away()
        self.list.reset()

    def note_edits(self, message: protocol.EditsChanged, shown: ShownRun) -> None:
        """Take over the working list of the shown run."""
        self.list.note(message, shown)
        if all(edit.id != self.selection.selected for edit in message.edits):
            self.selection.release()
            self.selection.selected = None
        self.refresh(shown)

    def refresh(self, shown: ShownRun | None) -> None:
        """Bring the preview up to date with the tools."""
        if shown is None:
            return
        draft = self.selection.moving or self.list.unconfirmed
        if draft is None and self.drawing.is_on and self._ground is not None:
            draft = self.drawing.edit(self._ground, with_hover=True)
        try:
            shown.document.set_draft(draft)
        except protocol.EditError as error:
            self._say(str(error))

    # --- drawing and picking ------------------------------------------------------------------------

    def _draw(self, command: Command, shown: ShownRun) -> bool:
        drawing = self.drawing
        if isinstance(command, (AddVertex, DropVertex, StrokeTo, EndStroke)) and not drawing.is_on:
            raise CommandError(f"{type(command).__name__} needs the edit tool: BeginEdit first")
        match command:
            case BeginEdit(kind):
                drawing.begin(kind)
                self.selection.put_away()
                self.picks_level = False
                self._ground = shown.document.ground()
            case AddVertex(x, y):
                if drawing.closes(x, y, self.reach()):
                    self._finish(shown)
                else:
                    drawing.add_vertex(x, y, shown.grid)
            case DropVertex():
                drawing.drop_vertex()
            case StrokeTo(x, y):
                drawing.stroke_to(x, y, shown.grid)
            case EndStroke():
                drawing.end_stroke(shown.grid)
            case FinishEdit():
                self._finish(shown)
            case CancelEdit():
                if self.picks_level:
                    self.picks_level = False
                else:
                    self._put_away()
            case _:
                return False
        return True

    def _pick(self, command: Command, shown: ShownRun) -> bool:
        selection = self.selection
        match command:
            case BeginSelect():
                self._put_away()
                selection.is_on = True
            case SelectEdit(name):
                selection.release()
                selection.selected = None if name is None else shown.document.edit(name).id
            case GrabEdit(x, y):
                edits = shown.document.edits
                selection.grab(edits, (x, y), self.reach(), shown.document.ground)
            case DragEdit(x, y):
                selection.drag((x, y), shown.grid)
            case DropEdit():
                edit = selection.release()
                if edit is not None:
                    self.list.replace(edit, shown)
            case BeginLevelPick():
                self.picks_level = True
            case TakeLevel(x, y):
                self._take_level(x, y, shown)
            case _:
                return False
        return True

    def _take_level(self, x: float, y: float, shown: ShownRun) -> None:
        self.picks_level = False
        found = self.look(x, y)
        if found is None:
            raise CommandError(f"the point ({x:.1f}, {y:.1f}) is outside the terrain")
        level = found.ground if found.level is None else found.level
        change = ChangeEditSettings(type="replace", level=round(level, 2), at_level=True)
        if self.selection.selected is None:
            self.drawing.settings = changed_settings(self.drawing.settings, change)
        else:
            self.list.alter(self.selection.selected, change, shown)
        self._say(f"level {level:.2f} m taken from the {'ground' if found.level is None else 'water'}")

    def _put_away(self) -> None:
        self.drawing.put_away()
        self.selection.put_away()
        self.picks_level = False

    def _finish(self, shown: ShownRun) -> None:
        if self.drawing.is_on:
            self.drawing.end_stroke(shown.grid)
        edit = None if self._ground is None else self.drawing.edit(self._ground, with_hover=False)
        if edit is None:
            needed = "two" if self.drawing.kind == "line" else "three"
            raise CommandError(f"an edit {self.drawing.kind} needs at least {needed} points")
        protocol.check_edit(edit, shown.grid)
        self.drawing.put_away()
        self.list.append((edit,), shown)
