"""What waits to be sent to one client, in two planes.

Control messages are never dropped: when too many wait, the client has stopped reading and is closed with a
reason. Bulk parts (terrain, frames) wait as iterators and are cut off one at a time, so that control goes in
between.
"""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Iterable, Iterator

CONTROL_MESSAGES = 1024
CONTROL_BYTES = 16 * 1024 * 1024


class Outbox:
    """Messages of one connection on their way out."""

    def __init__(self, max_messages: int = CONTROL_MESSAGES, max_bytes: int = CONTROL_BYTES) -> None:
        """An empty outbox.

        Args:
            max_messages: most control messages that may wait.
            max_bytes: most bytes of control messages that may wait.
        """
        self._max_messages = max_messages
        self._max_bytes = max_bytes
        self._control: deque[bytes] = deque()
        self._control_bytes = 0
        self._bulk: deque[Iterator[bytes]] = deque()
        self._wake = asyncio.Event()
        self.closing: tuple[int, str] | None = None

    @property
    def has_bulk(self) -> bool:
        """Whether parts of something large wait."""
        return bool(self._bulk)

    @property
    def bulk_count(self) -> int:
        """How many large things wait or are on their way."""
        return len(self._bulk)

    def put(self, packets: Iterable[bytes]) -> None:
        """Queue control messages; passing a limit closes the connection."""
        for packet in packets:
            self._control.append(packet)
            self._control_bytes += len(packet)
        if len(self._control) > self._max_messages or self._control_bytes > self._max_bytes:
            reason = f"{len(self._control)} messages of {self._control_bytes} bytes were left unread"
            self._control.clear()
            self._control_bytes = 0
            self.close(1013, reason)
        self._wake.set()

    def put_bulk(self, parts: Iterable[bytes]) -> None:
        """Queue the parts of something large."""
        self._bulk.append(iter(parts))
        self._wake.set()

    def close(self, code: int, reason: str) -> None:
        """Close after the control messages that wait; the first reason counts."""
        if self.closing is None:
            self.closing = (code, reason)
        self._wake.set()

    def wake(self) -> None:
        """Let the sender look again."""
        self._wake.set()

    def next(self) -> bytes | None:
        """The next message to send: control first, then one bulk part; None when nothing waits."""
        if self._control:
            packet = self._control.popleft()
            self._control_bytes -= len(packet)
            return packet
        if self.closing is not None:
            return None
        while self._bulk:
            part = next(self._bulk[0], None)
            if part is not None:
                return part
            self._bulk.popleft()
        return None

    async def wait(self) -> None:
        """Wait until something may have changed."""
        await self._wake.wait()
        self._wake.clear()
