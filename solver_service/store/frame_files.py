"""Frame bytes in append-only segment files: write, fsync, then the row.

A frame is the packed `frame` message: encoded once, stored, streamed live and replayed as the same bytes. The
packed channels of a frame lie behind it and have rows of their own, made together with that of the frame, so
that a run that is taken up never finds a frame that lacks its channels.
Each writer begins a segment of its own (never one that another process may still hold), so a torn tail can
only be the end of a segment whose writer is gone; it is cut off by `recover_segments`, which trusts the rows
alone.
"""

from __future__ import annotations

import os
import zlib
from collections.abc import Iterator, Mapping
from pathlib import Path
from types import MappingProxyType

from solver_service.errors import StoreError
from solver_service.store.data_folder import DataFolder, fsync_folder
from solver_service.store.records import ChannelRecord, FrameRecord
from solver_service.store.room import store_failure
from solver_service.store.run_database import RunDatabase

SEGMENT_BYTES = 256 * 1024 * 1024


class FrameWriter:
    """Appends the frames of one run; used by one thread."""

    def __init__(
        self, folder: DataFolder, database: RunDatabase, run: str, segment_bytes: int = SEGMENT_BYTES
    ) -> None:
        """A writer that has not touched the disk yet.

        Args:
            folder: the data folder.
            database: where the rows go; the connection of the calling thread.
            run: the run.
            segment_bytes: a segment that has reached this size is followed by a new one [bytes].
        """
        self._folder = folder
        self._database = database
        self._run = run
        self._segment_bytes = segment_bytes
        self._descriptor: int | None = None
        self._segment = ""
        self._end = 0

    def append(
        self,
        *,
        index: int,
        time: float,
        revision: int,
        key_index: int,
        frame: bytes,
        channels: Mapping[str, bytes] = MappingProxyType({}),
    ) -> FrameRecord:
        """Store one frame and its channels, by name; when this returns they survive a power cut.

        Raises:
            StoreError: the disk is full (`StoreFull`) or broken; nothing of the frame is visible and the call
                may be repeated.
        """
        try:
            descriptor = self._open_segment()
            content = b"".join((frame, *channels.values()))
            write_all(descriptor, content, self._end)
            os.fsync(descriptor)
            record = FrameRecord(
                run=self._run,
                index=index,
                time=time,
                revision=revision,
                key_index=key_index,
                segment=self._segment,
                offset=self._end,
                size=len(frame),
                crc32=zlib.crc32(frame),
            )
            self._database.insert_frame(record, self._channel_records(record, channels))
        except OSError as error:
            self._cut()
            raise store_failure(
                error, f"frame {index} of run {self._run} cannot be stored in {self._folder.root}"
            ) from error
        except StoreError:
            self._cut()
            raise
        self._end += len(content)
        return record

    def _channel_records(self, frame: FrameRecord, channels: Mapping[str, bytes]) -> Iterator[ChannelRecord]:
        offset = frame.offset + frame.size
        for name, content in channels.items():
            yield ChannelRecord(
                self._run, frame.index, name, frame.segment, offset, len(content), zlib.crc32(content)
            )
            offset += len(content)

    def close(self) -> None:
        """Close the segment."""
        if self._descriptor is not None:
            os.close(self._descriptor)
            self._descriptor = None

    def _open_segment(self) -> int:
        if self._descriptor is not None and self._end >= self._segment_bytes:
            self.close()
        if self._descriptor is None:
            self._segment, self._descriptor = new_segment(self._folder, self._run)
            self._end = 0
        return self._descriptor

    def _cut(self) -> None:
        """Take back the bytes that have no row."""
        if self._descriptor is not None:
            os.ftruncate(self._descriptor, self._end)


class FrameReader:
    """Reads frames and channels by their rows; safe from any thread."""

    def __init__(self, folder: DataFolder) -> None:
        """A reader below a data folder."""
        self._folder = folder

    def read(self, record: FrameRecord | ChannelRecord) -> bytes:
        """The packed frame or channel.

        Raises:
            StoreError: the bytes are missing or not those that were committed.
        """
        path = self._folder.frames(record.run) / record.segment
        try:
            with path.open("rb", buffering=0) as file:
                file.seek(record.offset)
                content = file.read(record.size)
        except OSError as error:
            raise StoreError(
                f"{record.name} cannot be read from {path}: {error.strerror or error}"
            ) from error
        if len(content) != record.size or zlib.crc32(content) != record.crc32:
            raise StoreError(f"{record.name} is damaged in {path}")
        return content


def recover_segments(folder: DataFolder, database: RunDatabase, run: str) -> int:
    """Cut torn tails after a crash, so that the files hold what the rows say and nothing more.

    Returns:
        The number of bytes that were cut off.
    """
    ends = database.segment_ends(run)
    cut = 0
    for path in sorted(folder.frames(run).glob("*.segment")):
        end = ends.get(path.name, 0)
        size = path.stat().st_size
        if end == 0:
            path.unlink(missing_ok=True)
        elif size > end:
            os.truncate(path, end)
        cut += max(size - end, 0)
    return cut


def new_segment(folder: DataFolder, run: str) -> tuple[str, int]:
    """Make the next segment file of a run; gives its name and a descriptor to write to."""
    path = folder.frames(run)
    path.mkdir(parents=True, exist_ok=True)
    number = 1 + max((int(file.stem) for file in path.glob("*.segment")), default=0)
    name = f"{number:06d}.segment"
    flags = os.O_RDWR | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0)
    descriptor = os.open(path / name, flags, 0o644)
    fsync_folder(path)
    return name, descriptor


def write_all(descriptor: int, content: bytes, offset: int) -> None:
    """Write the whole content at an offset, however little the system takes at a time."""
    os.lseek(descriptor, offset, os.SEEK_SET)
    view = memoryview(content)
    while view:
        view = view[os.write(descriptor, view) :]


def segment_files(folder: DataFolder, run: str) -> list[Path]:
    """The segment files of a run in the order in which they were begun."""
    return sorted(folder.frames(run).glob("*.segment"))
