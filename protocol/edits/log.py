"""The working list of edits of a run, with undo and redo."""

from __future__ import annotations

from collections.abc import Iterable

from protocol.edits.model import Edit
from protocol.errors import EditError
from protocol.limits import MAX_EDITS, MAX_LOG_VERTICES


class EditLog:
    """Edits in the order they apply; bed = base + list. Every change adds one to the revision.

    Args:
        edits: list to begin with.
        revision: revision of that list.
    """

    def __init__(self, edits: Iterable[Edit] = (), revision: int = 0) -> None:
        self._edits: list[Edit] = list(edits)
        self._undone: list[Edit] = []
        self._revision = revision

    @property
    def edits(self) -> tuple[Edit, ...]:
        """The list."""
        return tuple(self._edits)

    @property
    def revision(self) -> int:
        """Number of changes."""
        return self._revision

    @property
    def can_undo(self) -> bool:
        """Whether there is an edit to undo."""
        return bool(self._edits)

    @property
    def can_redo(self) -> bool:
        """Whether there is an edit to redo."""
        return bool(self._undone)

    def append(self, edit: Edit) -> int:
        """Add an edit at the end and forget what could be redone.

        Returns:
            The new revision.

        Raises:
            EditError: when the id is taken or the list is full.
        """
        if any(edit.id == other.id for other in self._edits):
            raise EditError(f"Edit {edit.id!r} is in the list already; a new id is allowed.")
        if len(self._edits) >= MAX_EDITS:
            raise EditError(f"Edit {edit.id!r} is one too many; up to {MAX_EDITS} are allowed.")
        vertex_count = len(edit.vertices) + sum(len(other.vertices) for other in self._edits)
        if vertex_count > MAX_LOG_VERTICES:
            raise EditError(
                f"Edit {edit.id!r} makes it {vertex_count} vertices in the list;"
                f" up to {MAX_LOG_VERTICES} are allowed."
            )
        self._edits.append(edit)
        self._undone.clear()
        return self._bump()

    def undo(self) -> int:
        """Take the last edit off the list.

        Returns:
            The new revision.

        Raises:
            EditError: when the list is empty.
        """
        if not self._edits:
            raise EditError("There is no edit to undo.")
        self._undone.append(self._edits.pop())
        return self._bump()

    def redo(self) -> int:
        """Put the edit that was last undone back.

        Returns:
            The new revision.

        Raises:
            EditError: when nothing was undone since the last new edit.
        """
        if not self._undone:
            raise EditError("There is no edit to redo.")
        self._edits.append(self._undone.pop())
        return self._bump()

    def _bump(self) -> int:
        self._revision += 1
        return self._revision
