import threading
from dataclasses import replace
from pathlib import Path

import pytest

from solver_service.errors import StoreError
from solver_service.store import (
    DataFolder,
    FrameReader,
    RunDatabase,
    back_up,
    compact_run,
    find_faults,
    remove_checkpoint,
)
from tests.solver_service.store.small_store import RUN, SmallStore


def test_a_copy_has_every_run_frame_and_checkpoint_and_no_fault(store: SmallStore, tmp_path: Path) -> None:
    size = back_up(store.folder, tmp_path / "copy")
    folder = DataFolder(tmp_path / "copy")
    database = RunDatabase(folder.database)
    assert database.runs() == store.database.runs()
    assert not list(find_faults(folder, database))
    for run in ("r1", "r2"):
        assert database.checkpoints(run) == store.database.checkpoints(run)
        frames = [FrameReader(folder).read(row) for row in database.frames(run)]
        assert frames == store.frames(run)
        channels = [FrameReader(folder).read(row) for row in database.channels(run)]
        assert channels == list(store.channels(run).values())
        assert len(channels) > len(frames)
    assert size > sum(len(frame) for frame in store.frames("r1"))
    assert not list(tmp_path.glob("*.writing"))
    database.close()


def test_a_folder_that_holds_something_is_refused_and_left_alone(store: SmallStore, tmp_path: Path) -> None:
    (tmp_path / "copy").mkdir()
    (tmp_path / "copy" / "mine").write_text("mine")
    with pytest.raises(StoreError, match="is not empty"):
        back_up(store.folder, tmp_path / "copy")
    assert (tmp_path / "copy" / "mine").read_text() == "mine"


def test_a_damaged_store_is_not_taken_for_a_backup(store: SmallStore, tmp_path: Path) -> None:
    row = store.database.frames("r1")[3]
    store.damage(store.folder.frames("r1") / row.segment)
    with pytest.raises(StoreError, match="is not whole: frame 3 of run r1 is damaged"):
        back_up(store.folder, tmp_path / "copy")
    assert not list(tmp_path.glob("copy*"))


def test_copies_are_whole_while_runs_are_written_moved_and_deleted(store: SmallStore, tmp_path: Path) -> None:
    stop = threading.Event()

    def disturb() -> None:
        database = RunDatabase(store.folder.database)
        database.begin_epoch()
        writer = SmallStore.__new__(SmallStore)
        writer.folder, writer.database = store.folder, database
        number = 0
        while not stop.is_set():
            number += 1
            name = f"n{number}"
            writer.add(replace(RUN, run=name), 4, segment_bytes=1)
            compact_run(store.folder, database, name)
            for record in database.checkpoints(name)[1:]:
                remove_checkpoint(database, store.folder, record)
            if number > 3:
                database.delete_run(name)
                for path in store.folder.frames(name).glob("*"):
                    path.unlink()
            stop.wait(0.2)
        database.close()

    thread = threading.Thread(target=disturb)
    thread.start()
    try:
        for number in range(3):
            back_up(store.folder, tmp_path / f"copy{number}")
            folder = DataFolder(tmp_path / f"copy{number}")
            database = RunDatabase(folder.database)
            assert not list(find_faults(folder, database))
            assert len(database.frames("r1")) == 40
            database.close()
    finally:
        stop.set()
        thread.join()
