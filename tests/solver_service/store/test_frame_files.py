import errno
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from solver_service.errors import StoreError
from solver_service.store import DataFolder, FrameReader, FrameRecord, FrameWriter, RunDatabase, RunRecord
from solver_service.store.frame_files import recover_segments, segment_files

RUN = RunRecord("r1", "case", "f00d", "Title", None, 0, "running", "", 100.0, 5.0, "auto", 0, b"[]", b"{}")


@pytest.fixture
def folder(tmp_path: Path) -> DataFolder:
    return DataFolder(tmp_path / "data")


@pytest.fixture
def database(folder: DataFolder) -> Iterator[RunDatabase]:
    database = RunDatabase(folder.database)
    database.begin_epoch()
    database.insert_run(RUN)
    yield database
    database.close()


def append(writer: FrameWriter, index: int, frame: bytes) -> FrameRecord:
    return writer.append(index=index, time=5.0 * index, revision=0, key_index=index, frame=frame)


def test_frames_are_read_back_as_the_same_bytes(folder: DataFolder, database: RunDatabase) -> None:
    writer = FrameWriter(folder, database, "r1")
    frames = [os.urandom(100 + index) for index in range(5)]
    for index, frame in enumerate(frames):
        append(writer, index, frame)
    reader = FrameReader(folder)
    assert [reader.read(record) for record in database.frames("r1")] == frames
    writer.close()


def test_a_segment_that_is_large_enough_is_followed_by_a_new_one(
    folder: DataFolder, database: RunDatabase
) -> None:
    writer = FrameWriter(folder, database, "r1", segment_bytes=250)
    for index in range(6):
        append(writer, index, bytes([index]) * 100)
    writer.close()
    assert [path.stat().st_size for path in segment_files(folder, "r1")] == [300, 300]
    reader = FrameReader(folder)
    assert [reader.read(record)[0] for record in database.frames("r1")] == list(range(6))


def test_channels_are_read_back_and_the_newest_at_or_before_a_frame_is_found(
    folder: DataFolder, database: RunDatabase
) -> None:
    writer, reader = FrameWriter(folder, database, "r1"), FrameReader(folder)
    for index in range(3):
        channels = {"maxima": b"old"} if index == 0 else {"velocity": bytes([index]) * index}
        writer.append(index=index, time=0.0, revision=0, key_index=index, frame=b"frame", channels=channels)
    writer.close()
    assert [reader.read(row) for row in database.frames("r1")] == [b"frame"] * 3
    assert [reader.read(row) for row in database.channels("r1")] == [b"old", b"\1", b"\2\2"]
    newest = [database.newest_channel("r1", index, "maxima") for index in range(3)]
    assert [row and row.index for row in newest] == [0, 0, 0]
    assert database.newest_channel("r1", 0, "velocity") is None
    row = database.newest_channel("r1", 9, "velocity")
    assert row is not None
    assert (row.index, reader.read(row)) == (2, b"\2\2")


def test_a_second_writer_never_touches_the_segment_of_the_first(
    folder: DataFolder, database: RunDatabase
) -> None:
    first, second = (FrameWriter(folder, database, "r1") for _ in range(2))
    append(first, 0, b"first")
    append(second, 1, b"second")
    append(first, 2, b"third")
    reader = FrameReader(folder)
    assert [reader.read(record) for record in database.frames("r1")] == [b"first", b"second", b"third"]
    first.close()
    second.close()


def test_a_torn_tail_is_cut_and_a_segment_without_rows_is_removed(
    folder: DataFolder, database: RunDatabase
) -> None:
    writer = FrameWriter(folder, database, "r1")
    append(writer, 0, b"whole")
    writer.close()
    with segment_files(folder, "r1")[0].open("ab") as file:
        file.write(b"half of a fra")
    (folder.frames("r1") / "000002.segment").write_bytes(b"no row at all")
    assert recover_segments(folder, database, "r1") == 26
    assert [path.stat().st_size for path in segment_files(folder, "r1")] == [5]
    assert FrameReader(folder).read(database.frames("r1")[0]) == b"whole"


def test_a_damaged_frame_is_told_and_not_delivered(folder: DataFolder, database: RunDatabase) -> None:
    writer = FrameWriter(folder, database, "r1")
    record = append(writer, 0, b"0123456789")
    writer.close()
    path = segment_files(folder, "r1")[0]
    path.write_bytes(b"0123x56789")
    with pytest.raises(StoreError, match="frame 0 of run r1 is damaged"):
        FrameReader(folder).read(record)
    path.write_bytes(b"0123")
    with pytest.raises(StoreError, match="damaged"):
        FrameReader(folder).read(record)


def test_on_a_full_disk_nothing_of_the_frame_is_visible_and_the_call_can_be_repeated(
    folder: DataFolder, database: RunDatabase, monkeypatch: pytest.MonkeyPatch
) -> None:
    writer = FrameWriter(folder, database, "r1")
    append(writer, 0, b"before")
    true_write = os.write

    def half_a_write(descriptor: int, content: bytes) -> int:
        if len(content) > 3:
            return true_write(descriptor, content[:3])
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr("solver_service.store.frame_files.os.write", half_a_write)
    with pytest.raises(StoreError, match="No space left on device"):
        append(writer, 1, b"after")
    monkeypatch.undo()
    assert [record.index for record in database.frames("r1")] == [0]
    assert segment_files(folder, "r1")[0].stat().st_size == 6
    record = append(writer, 1, b"after")
    assert FrameReader(folder).read(record) == b"after"
    writer.close()


_WRITER = """
import sys
from pathlib import Path
from solver_service.store import DataFolder, FrameWriter, RunDatabase
folder = DataFolder(Path(sys.argv[1]))
database = RunDatabase(folder.database, int(sys.argv[2]))
writer = FrameWriter(folder, database, "r1")
index = len(database.frames("r1"))
while True:
    frame = bytes([index % 251]) * 50_000
    writer.append(index=index, time=5.0 * index, revision=0, key_index=index, frame=frame)
    print(index, flush=True)
    index += 1
"""


def test_no_acknowledged_frame_is_lost_when_the_writer_is_killed(
    folder: DataFolder, database: RunDatabase
) -> None:
    acknowledged = -1
    for kill in range(5):
        command = [sys.executable, "-c", _WRITER, str(folder.root), str(database.epoch)]
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as writer:
            assert writer.stdout is not None
            for _ in range(3 + kill):
                acknowledged = int(writer.stdout.readline())
            writer.send_signal(signal.SIGKILL)
            acknowledged = max([acknowledged, *(int(line) for line in writer.stdout if line.endswith("\n"))])
        recover_segments(folder, database, "r1")
        records = database.frames("r1")
        assert [record.index for record in records] == list(range(len(records)))
        assert len(records) > acknowledged
        reader = FrameReader(folder)
        assert all(reader.read(record) == bytes([record.index % 251]) * 50_000 for record in records)
        assert sum(path.stat().st_size for path in segment_files(folder, "r1")) == 50_000 * len(records)
