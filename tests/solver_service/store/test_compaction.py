import errno
import os

import pytest

from solver_service.errors import StoreError, StoreFull
from solver_service.store import FrameReader, compact_run, find_faults, is_scattered, mend_run
from solver_service.store.frame_files import segment_files
from tests.solver_service.store.small_store import SmallStore


def test_the_frames_of_many_segments_lie_in_one_afterwards_with_the_same_bytes(store: SmallStore) -> None:
    before, channels = store.frames("r1"), store.channels("r1")
    assert len(channels) == 50
    assert len(segment_files(store.folder, "r1")) == 40
    assert is_scattered(store.database.frames("r1"))
    moved = compact_run(store.folder, store.database, "r1")
    assert moved == store.database.frames("r1")
    assert [path.name for path in segment_files(store.folder, "r1")] == ["000041.segment"]
    assert (store.frames("r1"), store.channels("r1")) == (before, channels)
    assert not is_scattered([*moved, *store.database.channels("r1")])
    assert not list(find_faults(store.folder, store.database))


def test_segments_keep_to_their_size(store: SmallStore) -> None:
    size = sum(piece.size for piece in (*store.database.frames("r1"), *store.database.channels("r1")))
    moved = compact_run(store.folder, store.database, "r1", segment_bytes=size // 4)
    assert 4 <= len({frame.segment for frame in moved}) <= 5
    assert not is_scattered([*moved, *store.database.channels("r1")], segment_bytes=size // 4)
    assert is_scattered(moved, segment_bytes=size), "as if the channels had no size and no segments were full"
    assert not list(find_faults(store.folder, store.database))


def test_a_full_disk_changes_nothing(store: SmallStore, monkeypatch: pytest.MonkeyPatch) -> None:
    before, rows = store.frames("r1"), store.database.frames("r1")
    written = []
    real = os.write

    def write(descriptor: int, content: bytes) -> int:
        written.append(len(content))
        if len(written) > 7:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        return real(descriptor, content)

    monkeypatch.setattr("solver_service.store.frame_files.os.write", write)
    with pytest.raises(StoreFull, match="cannot be moved together"):
        compact_run(store.folder, store.database, "r1")
    monkeypatch.undo()
    assert store.database.frames("r1") == rows
    assert store.frames("r1") == before
    assert not list(find_faults(store.folder, store.database))


def test_a_damaged_frame_is_left_where_it_is(store: SmallStore) -> None:
    store.damage(segment_files(store.folder, "r1")[5])
    rows = store.database.frames("r1")
    with pytest.raises(StoreError, match="frame 5 of run r1 is damaged"):
        compact_run(store.folder, store.database, "r1")
    assert store.database.frames("r1") == rows
    assert len(segment_files(store.folder, "r1")) == 40


def test_what_a_crash_leaves_on_either_side_of_the_commit_is_mended(
    store: SmallStore, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = store.frames("r1")

    class Crash(BaseException):
        pass

    def crash(*_: object) -> None:
        raise Crash

    monkeypatch.setattr(store.database, "move_frames", crash)
    with pytest.raises(Crash):
        compact_run(store.folder, store.database, "r1")
    monkeypatch.undo()
    mend_run(store.folder, store.database, "r1")
    assert not list(find_faults(store.folder, store.database))
    assert store.frames("r1") == before
    monkeypatch.setattr("pathlib.Path.unlink", crash)
    with pytest.raises(Crash):
        compact_run(store.folder, store.database, "r1")
    monkeypatch.undo()
    assert [FrameReader(store.folder).read(row) for row in store.database.frames("r1")] == before
    mend_run(store.folder, store.database, "r1")
    assert len(segment_files(store.folder, "r1")) == 1
    assert store.frames("r1") == before
