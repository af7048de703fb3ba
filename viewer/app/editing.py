"""From the edit tool to the working list: draw, finish, wait until the service has taken it."""

from __future__ import annotations

from collections.abc import Callable

import protocol
from viewer.app.edit_drawing import EditDrawing
from viewer.app.service_desk import ServiceDesk
from viewer.app.shown_run import ShownRun
from viewer.commands import (
    AddVertex,
    BeginEdit,
    CancelEdit,
    ChangeEditSettings,
    Command,
    CommandError,
    FinishEdit,
    Redo,
    Undo,
)
from viewer.world import Heightfield

__all__ = ["Editing"]


class Editing:
    """The edit tool with the run it edits.

    Attributes:
        drawing: the line being drawn.
        unconfirmed: a finished line that the service has not taken into the list yet; still shown as a
            preview.
    """

    def __init__(self, desk: ServiceDesk) -> None:
        self._desk = desk
        self._ground: Callable[[float, float], float] | None = None
        self.drawing = EditDrawing()
        self.unconfirmed: protocol.EditLine | None = None
        self.refused: Callable[[], None] | None = None

    def carry_out(self, command: Command, shown: ShownRun | None) -> bool:
        """Carry out an edit command; return False when it is none.

        Raises:
            CommandError: it makes no sense now.
            EditError: the line does not fit the terrain.
        """
        if isinstance(command, ChangeEditSettings):
            self.drawing.change(command)
            self.refresh(shown)
            return True
        if not isinstance(command, (BeginEdit, AddVertex, FinishEdit, CancelEdit, Undo, Redo)):
            return False
        if shown is None:
            raise CommandError("no run is shown yet")
        match command:
            case BeginEdit():
                self._ground = Heightfield(shown.grid, shown.document.bed_of(shown.document.edits)).sample
                self.drawing.begin()
            case AddVertex(x, y):
                if not self.drawing.is_on:
                    raise CommandError("AddVertex needs the edit tool: BeginEdit first")
                self.drawing.add_vertex(x, y, shown.grid)
            case FinishEdit():
                self._finish(shown)
            case CancelEdit():
                self.drawing.put_away()
            case Undo():
                self._desk.undo_edit(shown.run)
            case Redo():
                self._desk.redo_edit(shown.run)
        self.refresh(shown)
        return True

    def hover(self, at: tuple[float, float] | None, shown: ShownRun | None) -> None:
        """Let the rubber band end at `at`."""
        if self.drawing.is_on:
            self.drawing.hover = at
            self.refresh(shown)

    def reset(self) -> None:
        """Another run is shown: nothing is being drawn."""
        self.drawing.put_away()
        self.unconfirmed = None

    def note_edits(self, message: protocol.EditsChanged, shown: ShownRun) -> None:
        """Take over the working list of the shown run."""
        shown.document.mirror(message.revision, message.edits, message.can_undo, message.can_redo)
        waiting = self.unconfirmed
        if waiting is not None and any(edit.id == waiting.id for edit in message.edits):
            self.unconfirmed = None
        self.refresh(shown)

    def refresh(self, shown: ShownRun | None) -> None:
        """Bring the preview up to date with the tool."""
        if shown is None:
            return
        draft: protocol.EditLine | None = self.unconfirmed
        if draft is None and self.drawing.is_on and self._ground is not None:
            draft = self.drawing.line(self._ground, with_hover=True)
        shown.document.set_draft(draft)

    def _finish(self, shown: ShownRun) -> None:
        edit = None if self._ground is None else self.drawing.line(self._ground, with_hover=False)
        if edit is None:
            raise CommandError("an edit line needs at least two points")
        protocol.check_edit(edit, shown.grid)
        self.drawing.put_away()
        self.unconfirmed = edit

        def refused(_reason: str) -> None:
            self.unconfirmed = None
            self.refresh(shown)
            if self.refused is not None:
                self.refused()

        self._desk.append_edit(shown.run, edit, refused)
