"""Changes of the working lists of edits: each is stored before it counts."""

from __future__ import annotations

from protocol import Edit, EditsChanged, check_edit
from solver_service.runs.audience import Audience
from solver_service.runs.edit_change import EditChange
from solver_service.runs.run_status import Move, check_move
from solver_service.runs.run_tree import RunTree
from solver_service.runs.store_thread import StoreThread
from solver_service.store import EditEventKind, RunDatabase


class EditDesk:
    """The working lists of all runs."""

    def __init__(self, tree: RunTree, store: StoreThread, audience: Audience) -> None:
        """Work on the lists of a tree of runs."""
        self._tree = tree
        self._store = store
        self._audience = audience

    def changed(self, name: str) -> EditsChanged:
        """The working list of a run as it is told to viewers."""
        log = self._tree.get(name).edit_log
        return EditsChanged(name, log.revision, log.edits, log.can_undo, log.can_redo, log.undone)

    async def append(self, name: str, *edits: Edit) -> int:
        """Add edits to the working list, all or none; gives the new revision.

        Raises:
            EditError: an edit does not fit the terrain or the list.
        """
        kind = EditEventKind.APPEND if len(edits) == 1 else EditEventKind.APPEND_MANY
        return await self._change(name, EditChange(kind, edits))

    async def replace(self, name: str, edit: Edit) -> int:
        """Put an edit in the place of the one of the same id; gives the new revision.

        Raises:
            EditError: it does not fit the terrain, or the list has none of that id.
        """
        return await self._change(name, EditChange(EditEventKind.REPLACE, (edit,)))

    async def delete(self, name: str, edit: str) -> int:
        """Take the edit of an id out of the working list; gives the new revision.

        Raises:
            EditError: the list has none of that id.
        """
        return await self._change(name, EditChange(EditEventKind.DELETE, deleted=edit))

    async def undo(self, name: str) -> int:
        """Take the last change back; gives the new revision."""
        return await self._change(name, EditChange(EditEventKind.UNDO))

    async def redo(self, name: str) -> int:
        """Make the change that was last undone again; gives the new revision."""
        return await self._change(name, EditChange(EditEventKind.REDO))

    async def _change(self, name: str, change: EditChange) -> int:
        run = self._tree.get(name)
        for edit in change.edits:
            check_edit(edit, run.facts.grid.geometry)
        async with run.lock:
            check_move(run.run, run.status, Move.EDIT)
            log = run.edit_log.copy()  # the change is tried on a copy: it counts once it is stored
            revision = change.make(log)
            await self._store.call(RunDatabase.append_edit_event, change.event(run.run, revision))
            run.edit_log = log
        self._audience.announce(self.changed(run.run))
        return revision
