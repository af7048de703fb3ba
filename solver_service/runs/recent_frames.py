"""Frames that were read lately: several viewers of one run have each frame read from the disk once."""

from __future__ import annotations

import asyncio
from collections import OrderedDict
from collections.abc import Awaitable, Callable

from solver_service.store import FrameRecord

MOST_BYTES = 32 * 1024 * 1024


class RecentFrames:
    """Packed frames by their record, the least lately wanted dropped first; lives on the event loop.

    Args:
        read: reads a frame.
        most_bytes: what may be kept [bytes].
    """

    def __init__(self, read: Callable[[FrameRecord], Awaitable[bytes]], most_bytes: int = MOST_BYTES) -> None:
        """Nothing is kept yet."""
        self._read = read
        self._most_bytes = most_bytes
        self._bytes = 0
        self._kept: OrderedDict[FrameRecord, bytes] = OrderedDict()
        self._reading: dict[FrameRecord, asyncio.Task[bytes]] = {}

    async def get(self, record: FrameRecord) -> bytes:
        """The packed bytes of a frame; whoever wants one that is being read waits for that reading.

        Raises:
            StoreError: it cannot be read; nothing is kept then.
        """
        frame = self._kept.get(record)
        if frame is not None:
            self._kept.move_to_end(record)
            return frame
        task = self._reading.get(record)
        if task is None:
            task = asyncio.ensure_future(self._fetch(record))
            self._reading[record] = task
            task.add_done_callback(lambda done: self._done(record, done))
        # The reading goes on when whoever asked first has left: others may wait for it.
        return await asyncio.shield(task)

    def _done(self, record: FrameRecord, task: asyncio.Task[bytes]) -> None:
        del self._reading[record]
        if not task.cancelled():
            task.exception()  # who waits for it is told; everybody may have left

    async def _fetch(self, record: FrameRecord) -> bytes:
        frame = await self._read(record)
        if len(frame) <= self._most_bytes:
            self._kept[record] = frame
            self._bytes += len(frame)
            while self._bytes > self._most_bytes:
                self._bytes -= len(self._kept.popitem(last=False)[1])
        return frame
