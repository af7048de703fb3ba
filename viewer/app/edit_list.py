"""Changes of the working list: each is asked of the service and waited for."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import protocol
from protocol.limits import MAX_EDITS_AT_ONCE, MAX_VERTICES
from viewer.app.edit_alteration import altered, moved, renamed, with_vertex
from viewer.app.edit_geojson import read_edits, write_edits
from viewer.app.service_desk import ServiceDesk
from viewer.app.service_link import Refusal, Reply
from viewer.app.shown_run import ShownRun
from viewer.commands import (
    ChangeEdit,
    ChangeEditSettings,
    Command,
    CommandError,
    DeleteEdit,
    LoadEdits,
    MoveEdit,
    MoveVertex,
    Redo,
    RenameEdit,
    SaveEdits,
    Undo,
)
from viewer.commands.edits import EditListCommand
from viewer.view_status import EditSettings

__all__ = ["EditList"]


class EditList:
    """The working list of the shown run, as far as the user changes it.

    Args:
        desk: the dealings with the service.
        say: shows a sentence to the user.

    Attributes:
        unconfirmed: an edit that the service has not taken into the list yet; still shown as a preview.
        answered: called when the service has answered a change.
        settled: called when nothing waits any more, with whether all was taken.
    """

    def __init__(self, desk: ServiceDesk, say: Callable[[str], None]) -> None:
        self._desk = desk
        self._say = say
        self._asked = 0
        self._awaited_revision = 0
        self._epoch = 0
        self.unconfirmed: protocol.Edit | None = None
        self.answered: Callable[[ShownRun], None] = lambda _shown: None
        self.settled: Callable[[bool], None] = lambda _is_taken: None

    def knows(self, command: Command) -> bool:
        """Whether a command is about the working list."""
        return isinstance(command, EditListCommand)

    def is_waiting(self, shown: ShownRun | None) -> bool:
        """Whether a change is not in the list of the shown run yet."""
        return self._asked > 0 or (shown is not None and shown.document.revision < self._awaited_revision)

    def carry_out(
        self, command: Command, shown: ShownRun, selected: str | None, settings: EditSettings
    ) -> None:
        """Carry out a command about the working list.

        Args:
            command: the command.
            shown: the run on the picture.
            selected: id of the selected edit.
            settings: what features of a file become that do not say it.

        Raises:
            CommandError: it makes no sense now.
            EditError: an edit does not fit the terrain.
            EditFileError: a file cannot be read or written.
        """
        match command:
            case MoveEdit(dx, dy, name):
                edit = _chosen(name or selected, shown)
                self.replace(moved(edit, dx, dy, shown.grid, shown.document.ground(edit.id)), shown)
            case MoveVertex(number, x, y, name):
                edit = _chosen(name or selected, shown)
                ground = shown.document.ground(edit.id)
                self.replace(with_vertex(edit, number, (x, y), shown.grid, ground), shown)
            case ChangeEdit():
                self.alter(command.edit or selected, command, shown)
            case RenameEdit(text, name):
                self.replace(renamed(_chosen(name or selected, shown), text), shown)
            case DeleteEdit(name):
                gone = _chosen(name or selected, shown).id
                self._ask(lambda done, refused: self._desk.delete_edit(shown.run, gone, done, refused), shown)
            case SaveEdits(path):
                write_edits(Path(path), shown.document.edits, shown.grid)
                self._say(f"{len(shown.document.edits)} edits written to {path}")
            case LoadEdits(path):
                self._load(Path(path), shown, settings)
            case Undo():
                self._ask(lambda done, refused: self._desk.undo_edit(shown.run, done, refused), shown)
            case Redo():
                self._ask(lambda done, refused: self._desk.redo_edit(shown.run, done, refused), shown)

    def append(self, edits: Sequence[protocol.Edit], shown: ShownRun) -> None:
        """Ask to take edits into the list; one alone is shown until it is there."""
        self.unconfirmed = edits[0] if len(edits) == 1 else None
        for batch in _batches(edits):
            self._ask(_append(self._desk, shown.run, batch), shown)

    def replace(self, edit: protocol.Edit, shown: ShownRun) -> None:
        """Ask to put an edit in the place of the one of its id; one that is the same is left.

        Raises:
            EditError: it does not fit the terrain.
        """
        if edit == shown.document.edit(edit.id):
            return
        protocol.check_edit(edit, shown.grid)
        self.unconfirmed = edit
        self._ask(lambda done, refused: self._desk.replace_edit(shown.run, edit, done, refused), shown)

    def alter(self, name: str | None, command: ChangeEditSettings, shown: ShownRun) -> None:
        """Ask to give an edit other numbers.

        Raises:
            CommandError: there is no such edit, or a number is not allowed.
            EditError: it does not fit the terrain then.
        """
        edit = _chosen(name, shown)
        self.replace(altered(edit, command, shown.document.ground(edit.id)), shown)

    def note(self, message: protocol.EditsChanged, shown: ShownRun) -> None:
        """Take over the working list of the shown run."""
        was_waiting = self.is_waiting(shown)
        shown.document.mirror(
            message.revision, message.edits, message.can_undo, message.can_redo, message.undone
        )
        if self.unconfirmed in message.edits:
            self.unconfirmed = None
        if was_waiting:
            self._settle(shown)

    def reset(self) -> None:
        """Another run is shown: answers to what was asked before are of no interest."""
        self._epoch += 1
        self._asked = self._awaited_revision = 0
        self.unconfirmed = None

    def _load(self, path: Path, shown: ShownRun, settings: EditSettings) -> None:
        listed = {edit.id for edit in shown.document.edits}
        edits = read_edits(path, shown.grid, settings, shown.document.ground(), listed)
        if not edits:
            raise CommandError(f"{path}: has no edits")
        self.append(edits, shown)
        self._say(f"{len(edits)} edits read from {path}")

    def _ask(self, send: Callable[[Reply, Refusal], None], shown: ShownRun) -> None:
        """Ask for a change and wait for the answer."""
        self._asked += 1
        epoch = self._epoch

        def done(result: Mapping[str, object]) -> None:
            if epoch == self._epoch:
                self._asked -= 1
                revision = result["revision"]
                assert isinstance(revision, int)
                self._awaited_revision = max(self._awaited_revision, revision)
                self._settle(shown)

        def refused(_reason: str) -> None:
            if epoch == self._epoch:
                self._asked -= 1
                self.unconfirmed = None
                self.answered(shown)
                self.settled(False)

        send(done, refused)

    def _settle(self, shown: ShownRun) -> None:
        if not self.is_waiting(shown):
            self.unconfirmed = None
            self.answered(shown)
            self.settled(True)


def _chosen(name: str | None, shown: ShownRun) -> protocol.Edit:
    if name is None:
        raise CommandError("no edit is selected")
    return shown.document.edit(name)


def _append(desk: ServiceDesk, run: str, edits: Sequence[protocol.Edit]) -> Callable[[Reply, Refusal], None]:
    return lambda done, refused: desk.append_edits(run, edits, done, refused)


def _batches(edits: Sequence[protocol.Edit]) -> list[list[protocol.Edit]]:
    """Parts of a list that a service takes at once."""
    batches: list[list[protocol.Edit]] = [[]]
    vertices = 0
    for edit in edits:
        vertices += len(edit.vertices)
        if batches[-1] and (len(batches[-1]) == MAX_EDITS_AT_ONCE or vertices > MAX_VERTICES):
            batches.append([])
            vertices = len(edit.vertices)
        batches[-1].append(edit)
    return batches
