"""Changes of the working lists of edits: each is stored before it counts."""

from __future__ import annotations

from protocol import Edit, EditsChanged, check_edit
from solver_service.runs.audience import Audience
from solver_service.runs.edit_blobs import pack_edit
from solver_service.runs.run_status import Move, check_move
from solver_service.runs.run_tree import Run, RunTree, replayed_log
from solver_service.runs.store_thread import StoreThread
from solver_service.store import EditEvent, EditEventKind, RunDatabase


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
        return EditsChanged(name, log.revision, log.edits, log.can_undo, log.can_redo)

    async def append(self, name: str, edit: Edit) -> int:
        """Add an edit to the working list; gives the new revision.

        Raises:
            EditError: the edit does not fit the terrain or the list.
        """
        run = self._tree.get(name)
        check_edit(edit, run.facts.grid.geometry)
        return await self._change(run, EditEventKind.APPEND, edit)

    async def undo(self, name: str) -> int:
        """Take the last edit off the working list; gives the new revision."""
        return await self._change(self._tree.get(name), EditEventKind.UNDO)

    async def redo(self, name: str) -> int:
        """Put the edit that was last undone back; gives the new revision."""
        return await self._change(self._tree.get(name), EditEventKind.REDO)

    async def _change(self, run: Run, kind: EditEventKind, edit: Edit | None = None) -> int:
        async with run.lock:
            check_move(run.run, run.status, Move.EDIT)
            events = await self._store.call(RunDatabase.edit_events, run.run)
            log = replayed_log(events)  # the change is tried on a copy: it counts once it is stored
            if kind is EditEventKind.APPEND and edit is not None:
                log.append(edit)
            elif kind is EditEventKind.UNDO:
                log.undo()
            else:
                log.redo()
            packed = pack_edit(edit) if edit is not None else b""
            event = EditEvent(run.run, len(events) + 1, kind, packed)
            await self._store.call(RunDatabase.append_edit_event, event)
            run.edit_log = log
        self._audience.announce(self.changed(run.run))
        return log.revision
