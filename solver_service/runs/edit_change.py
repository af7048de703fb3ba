"""One change of a working list of edits: made on a log, and kept in the store."""

from __future__ import annotations

from dataclasses import dataclass

import msgspec

from protocol import Edit, EditLog
from solver_service.runs.edit_blobs import pack_edit, pack_edits, unpack_edit, unpack_edits
from solver_service.store import EditEvent, EditEventKind


@dataclass(frozen=True)
class EditChange:
    """What a command makes of a working list.

    Attributes:
        kind: what happens.
        edits: what is added, or put in the place of the edit of its id.
        deleted: id of the edit that is deleted.
    """

    kind: EditEventKind
    edits: tuple[Edit, ...] = ()
    deleted: str = ""

    def make(self, log: EditLog) -> int:
        """Change a log; gives its new revision.

        Raises:
            EditError: the list does not allow it; the log is as it was.
        """
        match self.kind:
            case EditEventKind.APPEND | EditEventKind.APPEND_MANY:
                return log.append(*self.edits)
            case EditEventKind.REPLACE:
                return log.replace(self.edits[0])
            case EditEventKind.DELETE:
                return log.delete(self.deleted)
            case EditEventKind.UNDO:
                return log.undo()
            case EditEventKind.REDO:
                return log.redo()

    def event(self, run: str, sequence: int) -> EditEvent:
        """The row that keeps it."""
        packed = b""
        match self.kind:
            case EditEventKind.APPEND | EditEventKind.REPLACE:
                packed = pack_edit(self.edits[0])
            case EditEventKind.APPEND_MANY:
                packed = pack_edits(self.edits)
            case EditEventKind.DELETE:
                packed = msgspec.msgpack.encode(self.deleted)
        return EditEvent(run, sequence, self.kind, packed)

    @classmethod
    def of(cls, event: EditEvent) -> EditChange:
        """What a row keeps."""
        match event.kind:
            case EditEventKind.APPEND | EditEventKind.REPLACE:
                return cls(event.kind, (unpack_edit(event.edit),))
            case EditEventKind.APPEND_MANY:
                return cls(event.kind, unpack_edits(event.edit))
            case EditEventKind.DELETE:
                return cls(event.kind, deleted=msgspec.msgpack.decode(event.edit, type=str))
            case EditEventKind.UNDO | EditEventKind.REDO:
                return cls(event.kind)
