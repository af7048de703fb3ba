"""Few large segment files instead of many small ones: every pause and resume of a run begins another."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import replace

from solver_service.errors import StoreError
from solver_service.store.data_folder import DataFolder, fsync_folder
from solver_service.store.frame_files import (
    SEGMENT_BYTES,
    FrameReader,
    new_segment,
    segment_files,
    write_all,
)
from solver_service.store.records import ChannelRecord, FrameRecord
from solver_service.store.room import store_failure
from solver_service.store.run_database import RunDatabase


def is_scattered(pieces: Sequence[FrameRecord | ChannelRecord], segment_bytes: int = SEGMENT_BYTES) -> bool:
    """Whether the frames and channels of a run lie in more segments than their size asks for."""
    size = sum(piece.size for piece in pieces)
    return len({piece.segment for piece in pieces}) > 1 + size // segment_bytes


def compact_run(
    folder: DataFolder, database: RunDatabase, run: str, segment_bytes: int = SEGMENT_BYTES
) -> list[FrameRecord]:
    """Copy the frames of a run and their channels, in order, into new segments and remove the old ones.

    Nobody may write for the run meanwhile; who reads finds a frame by its old row or by its new one. A crash
    leaves either all old rows or all new ones, and files without rows, which `mend_run` removes.

    Args:
        folder: the data folder.
        database: the connection of the calling thread.
        run: the run.
        segment_bytes: a segment that has reached this size is followed by a new one [bytes].

    Returns:
        The new rows of the frames.

    Raises:
        StoreError: a frame or channel is damaged or there is no room; nothing has changed.
    """
    old, reader = segment_files(folder, run), FrameReader(folder)
    frames: list[FrameRecord] = []
    channels: list[ChannelRecord] = []
    pieces: list[FrameRecord | ChannelRecord] = [*database.frames(run), *database.channels(run)]
    made: list[str] = []
    descriptor, end = -1, segment_bytes
    try:
        for piece in sorted(pieces, key=lambda piece: piece.index):  # a frame before its channels
            content = reader.read(piece)
            if end >= segment_bytes:
                descriptor = _closed(descriptor)
                name, descriptor = new_segment(folder, run)
                made.append(name)
                end = 0
            write_all(descriptor, content, end)
            if isinstance(piece, FrameRecord):
                frames.append(replace(piece, segment=made[-1], offset=end))
            else:
                channels.append(replace(piece, segment=made[-1], offset=end))
            end += piece.size
        _closed(descriptor)
        descriptor = -1
        database.move_frames(frames, channels)
    except (OSError, StoreError) as error:
        if descriptor >= 0:
            os.close(descriptor)
        for name in made:
            (folder.frames(run) / name).unlink(missing_ok=True)
        if isinstance(error, OSError):
            raise store_failure(error, f"frames of run {run} cannot be moved together") from error
        raise
    for path in old:
        path.unlink()
    fsync_folder(folder.frames(run))
    return frames


def _closed(descriptor: int) -> int:
    """Force a segment to the disk and close it."""
    if descriptor >= 0:
        os.fsync(descriptor)
        os.close(descriptor)
    return -1
