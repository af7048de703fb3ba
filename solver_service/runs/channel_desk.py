"""Channels and series of stored frames on request, the shared past of a branch from its ancestors."""

from __future__ import annotations

import asyncio

from protocol import ChannelName, Series, join_series, pack, unpack_channel
from solver_service.errors import RunError, StoreError
from solver_service.runs.channels import kept_channels
from solver_service.runs.frame_series import SERIES
from solver_service.runs.run_tree import RunTree
from solver_service.runs.store_thread import StoreThread
from solver_service.store import ChannelRecord, FrameReader, RunDatabase

ANSWER_BYTES = 16 << 20
"""Series of one answer; who wants more asks again from where it ended."""


class ChannelDesk:
    """Finds and reads channels and series."""

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
        holder = self._holder(name, index)
        return await self._read(await self._row(holder, index, channel))

    async def series(self, name: str, from_index: int) -> tuple[int, bytes]:
        """What gauges and sections recorded from a frame of a run or of its past on.

        Returns:
            The last frame index that is reached, and the packed series.

        Raises:
            RunError: the run has no series, or the frame is not computed yet.
            StoreError: they are damaged.
        """
        end = self._tree.get(name).frame_count
        self._holder(name, from_index)
        legs = self._tree.legs(name)
        bounds = [leg.first_index for leg in legs[1:]] + [end]
        rows: list[ChannelRecord] = []
        for leg, leg_end in zip(legs, bounds, strict=True):
            first, leg_end = max(leg.first_index, from_index), min(leg_end, end)
            rows += await self._store.call(RunDatabase.channel_rows, leg.run, SERIES, first, leg_end)
        pieces: list[Series] = []
        size = 0
        for row in rows:
            size += row.size
            if pieces and size > ANSWER_BYTES:
                break
            piece = unpack_channel(await self._read(row))
            assert isinstance(piece, Series)
            pieces.append(piece)
        if not pieces:
            raise RunError(f"run {name} has no series from frame {from_index} on: no gauge and no section")
        return pieces[-1].index, await asyncio.to_thread(lambda: pack(join_series(pieces)))

    def _holder(self, name: str, index: int) -> str:
        """The run that holds a frame."""
        run, frame = self._tree.get(name), self._tree.frame(name, index)
        if frame is None:
            raise RunError(
                f"frame {index} of run {name} is not computed yet; 0 to {run.frame_count - 1} are there"
            )
        return frame.run

    async def _read(self, record: ChannelRecord) -> bytes:
        try:
            return await asyncio.to_thread(self._reader.read, record)
        except StoreError:  # it may have moved to another segment since the row was read
            where = (record.run, record.channel, record.index, record.index + 1)
            moved = await self._store.call(RunDatabase.channel_rows, *where)
            if not moved or moved[0] == record:
                raise
            return await asyncio.to_thread(self._reader.read, moved[0])

    async def _row(self, holder: str, index: int, channel: ChannelName) -> ChannelRecord:
        record = await self._store.call(RunDatabase.newest_channel, holder, index, channel)
        if record is None or (record.index != index and channel != "maxima"):
            raise RunError(f"no {channel} is kept with frame {index} of run {holder}")
        return record
