"""Channels of stored frames on request, the shared past of a branch from its ancestors."""

from __future__ import annotations

import asyncio

from protocol import ChannelName
from solver_service.errors import RunError, StoreError
from solver_service.runs.channels import kept_channels
from solver_service.runs.run_tree import RunTree
from solver_service.runs.store_thread import StoreThread
from solver_service.store import ChannelRecord, FrameReader, RunDatabase


class ChannelDesk:
    """Finds and reads channels."""

    def __init__(self, tree: RunTree, store: StoreThread, reader: FrameReader) -> None:
        self._tree = tree
        self._store = store
        self._reader = reader

    async def read(self, name: str, index: int, channel: ChannelName) -> bytes:
        """The packed channel of a frame of a run or of its past; for maxima the newest at or before it.

        Raises:
            RunError: the run keeps no such channel, the frame is not computed yet, or it came without.
            StoreError: the channel is damaged.
        """
        run = self._tree.get(name)
        kept = kept_channels(run.record.channel_names)
        if channel not in kept:
            told = " and ".join(kept) or "nothing beside the depth"
            raise RunError(f"run {name} keeps {told}, not {channel}; a run that is started with it does")
        frame = self._tree.frame(name, index)
        if frame is None:
            raise RunError(
                f"frame {index} of run {name} is not computed yet; 0 to {run.frame_count - 1} are there"
            )
        record = await self._row(frame.run, index, channel)
        try:
            return await asyncio.to_thread(self._reader.read, record)
        except StoreError:  # it may have moved to another segment since the row was read
            again = await self._row(frame.run, index, channel)
            if again == record:
                raise
            return await asyncio.to_thread(self._reader.read, again)

    async def _row(self, holder: str, index: int, channel: ChannelName) -> ChannelRecord:
        record = await self._store.call(RunDatabase.newest_channel, holder, index, channel)
        if record is None or (record.index != index and channel != "maxima"):
            raise RunError(f"no {channel} is kept with frame {index} of run {holder}")
        return record
