"""Changes of the working list of terrain edits."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from protocol.edits.model import Edit
from protocol.fields import Command, Identifier, Message, Revision
from protocol.limits import MAX_EDITS


class AppendEdit(Command, frozen=True):
    """Add an edit to the end of a run's working list; clears what could be redone.

    Attributes:
        run: id of the run.
        edit: the edit.
    """

    run: Identifier
    edit: Edit


class UndoEdit(Command, frozen=True):
    """Take the last edit off the working list.

    Attributes:
        run: id of the run.
    """

    run: Identifier


class RedoEdit(Command, frozen=True):
    """Put the edit that was last undone back.

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
    """

    run: Identifier
    revision: Revision
    edits: Annotated[tuple[Edit, ...], Meta(max_length=MAX_EDITS)]
    can_undo: bool = False
    can_redo: bool = False
