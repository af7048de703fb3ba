"""Which frame a client gets next: the newest or the next in order, keys before deltas."""

from __future__ import annotations

from dataclasses import dataclass

from protocol import ServerSession
from solver_service.errors import StoreError
from solver_service.runs import RunRegistry
from solver_service.store import FrameRecord


@dataclass
class _Cursor:
    run: str
    next_index: int
    live: bool


class FrameFeed:
    """The subscription of one connection."""

    def __init__(self, registry: RunRegistry, session: ServerSession) -> None:
        self._registry = registry
        self._session = session
        self._cursor: _Cursor | None = None

    @property
    def run(self) -> str | None:
        """The run that is watched."""
        return self._cursor.run if self._cursor is not None else None

    def follow_session(self) -> None:
        """Begin where the session's subscription says."""
        wanted = self._session.subscription
        self._cursor = None
        if wanted is not None:
            self._cursor = _Cursor(wanted.run, wanted.from_index, wanted.mode == "live")

    def leave(self, run: str) -> None:
        """Send nothing more of a run that is gone."""
        if self.run == run:
            self._cursor = None

    def move_to(self, run: str, index: int) -> None:
        """Go on with another run from a frame index; what was watched is left."""
        if self._cursor is not None:
            self._session.move_to(run, index)
            self._cursor = _Cursor(run, index, self._cursor.live)

    async def next(self) -> bytes | None:
        """The next frame, packed, or None when there is none to send now.

        Raises:
            StoreError: the frame is damaged; it is passed over by the next call.
        """
        cursor = self._cursor
        if cursor is None or not self._session.can_send_frame:
            return None
        record = self._choose(cursor)
        if record is None:
            return None
        wanted = record.index
        key = self._session.needed_key(record.run, record.key_index)
        if key is not None and key != record.index:
            holder = self._registry.tree.get(record.run)
            record = holder.frames[key - holder.first_index]
        elif record.index >= cursor.next_index:
            cursor.next_index = wanted + 1
        try:
            frame = await self._registry.read_frame(record)
        except StoreError:
            if cursor is not self._cursor:
                return None  # nobody wants it any more; its run may have been deleted
            cursor.next_index = max(cursor.next_index, wanted + 1)
            raise
        # whoever moved the cursor while the bytes were read wants another frame now
        return frame if cursor is self._cursor else None

    def _choose(self, cursor: _Cursor) -> FrameRecord | None:
        tree = self._registry.tree
        index = cursor.next_index
        if cursor.live:
            index = max(index, tree.get(cursor.run).frame_count - 1)
        return tree.frame(cursor.run, index)
