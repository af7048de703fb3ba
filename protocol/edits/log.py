"""The working list of edits of a run, with undo and redo of every change."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Self

from protocol.edits.model import Edit
from protocol.errors import EditError
from protocol.limits import MAX_EDITS, MAX_HISTORY_VERTICES, MAX_LOG_VERTICES

Edits = tuple[Edit, ...]


@dataclass(frozen=True)
class _Step:
    """From place `at` on, `before` became `after`; the other way round it is its own undoing."""

    at: int
    before: Edits
    after: Edits

    @property
    def vertex_count(self) -> int:
        return _vertex_count(self.before + self.after)


class EditLog:
    """Edits in the order they apply; bed = base + list. Every change adds one to the revision.

    Args:
        edits: list to begin with.
        revision: revision of that list.
    """

    def __init__(self, edits: Iterable[Edit] = (), revision: int = 0) -> None:
        self._edits = tuple(edits)
        self._done = deque(_Step(at, (), (edit,)) for at, edit in enumerate(self._edits))
        self._undone: list[_Step] = []
        self._history = sum(step.vertex_count for step in self._done)
        self._revision = revision

    @property
    def edits(self) -> Edits:
        """The list."""
        return self._edits

    @property
    def undone(self) -> Edits:
        """The edits that redoing would bring into the list, the next one first.

        Those that would not fit beside the list within `MAX_EDITS` and `MAX_LOG_VERTICES` are left out.
        """
        found = {edit.id: edit for edit in self._edits}
        vertices = _vertex_count(self._edits)
        for step in reversed(self._undone):
            for edit in step.after:
                if edit.id in found:
                    continue
                vertices += len(edit.vertices)
                if len(found) >= MAX_EDITS or vertices > MAX_LOG_VERTICES:
                    return tuple(found.values())[len(self._edits) :]
                found[edit.id] = edit
        return tuple(found.values())[len(self._edits) :]

    @property
    def revision(self) -> int:
        """Number of changes."""
        return self._revision

    @property
    def can_undo(self) -> bool:
        """Whether there is a change to undo."""
        return bool(self._done)

    @property
    def can_redo(self) -> bool:
        """Whether there is a change to redo."""
        return bool(self._undone)

    def copy(self) -> Self:
        """A log with the same list and history that changes on its own."""
        other = type(self)((), self._revision)
        other._edits, other._history = self._edits, self._history
        other._done, other._undone = self._done.copy(), self._undone.copy()
        return other

    def append(self, *edits: Edit) -> int:
        """Add edits at the end, as one change, and forget what could be redone.

        Returns:
            The new revision.

        Raises:
            EditError: when an id is taken or the list is full.
        """
        taken = {edit.id for edit in self._edits}
        for edit in edits:
            if edit.id in taken:
                raise EditError(f"Edit {edit.id!r} is in the list already; a new id is allowed.")
            taken.add(edit.id)
        return self._change(_Step(len(self._edits), (), edits))

    def replace(self, edit: Edit) -> int:
        """Put an edit in the place of the one of the same id and forget what could be redone.

        Returns:
            The new revision.

        Raises:
            EditError: when the list has no such edit, or too many vertices with this one.
        """
        at = self._place(edit.id)
        return self._change(_Step(at, self._edits[at : at + 1], (edit,)))

    def delete(self, name: str) -> int:
        """Take an edit out of the list and forget what could be redone.

        Args:
            name: its id.

        Returns:
            The new revision.

        Raises:
            EditError: when the list has no such edit.
        """
        at = self._place(name)
        return self._change(_Step(at, self._edits[at : at + 1], ()))

    def undo(self) -> int:
        """Take the last change back.

        Returns:
            The new revision.

        Raises:
            EditError: when there is none.
        """
        if not self._done:
            raise EditError("There is no edit to undo.")
        step = self._done.pop()
        self._undone.append(step)
        self._put(step.at, step.after, step.before)
        return self._bump()

    def redo(self) -> int:
        """Make the change that was last undone again.

        Returns:
            The new revision.

        Raises:
            EditError: when nothing was undone since the last new change.
        """
        if not self._undone:
            raise EditError("There is no edit to redo.")
        step = self._undone.pop()
        self._done.append(step)
        self._put(step.at, step.before, step.after)
        return self._bump()

    def _place(self, name: str) -> int:
        for at, edit in enumerate(self._edits):
            if edit.id == name:
                return at
        raise EditError(f"Edit {name!r} is not in the list; the id of one that is in it is allowed.")

    def _change(self, step: _Step) -> int:
        self._check_room(step)
        self._put(step.at, step.before, step.after)
        self._history += step.vertex_count - sum(undone.vertex_count for undone in self._undone)
        self._undone.clear()
        self._done.append(step)
        while self._history > MAX_HISTORY_VERTICES:
            self._history -= self._done.popleft().vertex_count
        return self._bump()

    def _check_room(self, step: _Step) -> None:
        count = len(self._edits) + len(step.after) - len(step.before)
        if step.after and count > MAX_EDITS:
            raise EditError(f"Edit {step.after[-1].id!r} is one too many; up to {MAX_EDITS} are allowed.")
        vertices = _vertex_count(self._edits) + _vertex_count(step.after) - _vertex_count(step.before)
        if step.after and vertices > MAX_LOG_VERTICES:
            raise EditError(
                f"Edit {step.after[-1].id!r} makes it {vertices} vertices in the list;"
                f" up to {MAX_LOG_VERTICES} are allowed."
            )

    def _put(self, at: int, old: Edits, new: Edits) -> None:
        self._edits = self._edits[:at] + new + self._edits[at + len(old) :]

    def _bump(self) -> int:
        self._revision += 1
        return self._revision


def _vertex_count(edits: Edits) -> int:
    return sum(len(edit.vertices) for edit in edits)
