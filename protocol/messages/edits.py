"""Changes of the working list of terrain edits."""

from __future__ import annotations

from typing import Annotated, ClassVar

from msgspec import Meta

from protocol.edits.model import Edit
from protocol.fields import Command, Identifier, Message, Revision
from protocol.limits import MAX_EDITS, MAX_EDITS_AT_ONCE


class AppendEdit(Command, frozen=True):
    """Add an edit to the end of a run's working list; clears what could be redone.

    Attributes:
        run: id of the run.
        edit: the edit.
    """

    run: Identifier
    edit: Edit


class AppendEdits(Command, frozen=True):
    """Add edits to the end of a run's working list, all or none; one `undo_edit` takes them all back.

    Attributes:
        run: id of the run.
        edits: the edits in order.
    """

    run: Identifier
    edits: Annotated[tuple[Edit, ...], Meta(min_length=1, max_length=MAX_EDITS_AT_ONCE)]


class ReplaceEdit(Command, frozen=True):
    """Put an edit in the place of the one of the same id: moved, renamed or otherwise changed.

    An edit of type `replace` without `level` takes a new `reference_z` where it goes.

    Attributes:
        run: id of the run.
        edit: the edit as it is to be.
    """

    run: Identifier
    edit: Edit


class DeleteEdit(Command, frozen=True):
    """Take an edit out of the working list, wherever it stands.

    Attributes:
        run: id of the run.
        edit: id of the edit.
    """

    run: Identifier
    edit: Identifier


class UndoEdit(Command, frozen=True):
    """Take back the last change of the working list: an edit added, replaced or deleted.

    Attributes:
        run: id of the run.
    """

    run: Identifier


class RedoEdit(Command, frozen=True):
    """Make the change of the working list that was last undone again.

    Attributes:
        run: id of the run.
    """

    run: Identifier


class EditsChanged(Message, frozen=True):
    """The working list of a run, after each change, for every watcher. The bed changes by `recalculate` only.

    Attributes:
        run: id of the run.
        revision: revision of the list; grows by one with every change.
        edits: the list in order.
        can_undo: whether `undo_edit` would do something.
        can_redo: whether `redo_edit` would do something.
        undone: edits that are not in the list and that `redo_edit` would bring back, the next one first; as
            many as a list has room for beside `edits`.
    """

    left_out: ClassVar[tuple[str, ...]] = ("undone",)

    run: Identifier
    revision: Revision
    edits: Annotated[tuple[Edit, ...], Meta(max_length=MAX_EDITS)]
    can_undo: bool = False
    can_redo: bool = False
    undone: Annotated[tuple[Edit, ...], Meta(max_length=MAX_EDITS)] = ()
