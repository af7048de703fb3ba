import shutil
import sqlite3

import pytest

from solver_service.store import find_faults, repair
from solver_service.store.frame_files import segment_files
from tests.solver_service.store.small_store import SmallStore


def sentences(store: SmallStore) -> list[str]:
    return [fault.sentence for fault in find_faults(store.folder, store.database)]


def mend(store: SmallStore) -> list[str]:
    return repair(store.folder, store.database, list(find_faults(store.folder, store.database)))


def test_a_whole_store_has_no_fault_and_repair_leaves_it_alone(store: SmallStore) -> None:
    assert sentences(store) == []
    before = store.frames("r1"), store.frames("r2")
    assert mend(store) == []
    assert (store.frames("r1"), store.frames("r2")) == before
    assert [run.status for run in store.database.runs()] == ["finished", "finished"]


@pytest.mark.parametrize("index", [0, 17, 39])
def test_from_a_damaged_frame_on_a_run_is_computed_again(store: SmallStore, index: int) -> None:
    store.damage(segment_files(store.folder, "r1")[index])
    (sentence,) = sentences(store)
    assert f"frame {index} of run r1 is damaged" in sentence
    assert mend(store) == [f"forgot {40 - index} frames of run r1 from index {index} on"]
    assert sentences(store) == []
    assert len(store.frames("r1")) == index
    status = {run.run: (run.status, run.status_reason) for run in store.database.runs()}
    assert status["r1"][0] == "paused"
    assert "resume computes them again" in status["r1"][1]
    assert status["r2"] == ("finished", "")


def test_a_damaged_channel_is_forgotten_alone(store: SmallStore) -> None:
    row = store.database.channels("r1")[1]
    path = store.folder.frames("r1") / row.segment
    content = bytearray(path.read_bytes())
    content[row.offset] ^= 0xFF
    path.write_bytes(content)
    (sentence,) = sentences(store)
    assert f"{row.channel} of frame {row.index} of run r1 is damaged" in sentence
    assert mend(store) == [f"forgot channel {row.channel} of frame {row.index} of run r1"]
    assert sentences(store) == []
    assert len(store.frames("r1")) == 40
    assert len(store.channels("r1")) == 49
    assert {run.status for run in store.database.runs()} == {"finished"}


def test_frames_that_are_forgotten_take_their_channels_along(store: SmallStore) -> None:
    store.damage(segment_files(store.folder, "r1")[17])
    mend(store)
    assert max(index for index, _ in store.channels("r1")) == 16
    store.database.delete_run("r2")
    assert store.channels("r2") == {}


def test_a_missing_segment_is_found(store: SmallStore) -> None:
    segment_files(store.folder, "r1")[20].unlink()
    assert "cannot be read" in sentences(store)[0]
    mend(store)
    assert sentences(store) == []
    assert len(store.frames("r1")) == 20


def test_a_damaged_checkpoint_is_forgotten_and_the_others_stay(store: SmallStore) -> None:
    record = store.database.checkpoints("r1")[-1]
    for path in (store.folder.checkpoints("r1") / record.name).rglob("c/*/*"):
        store.damage(path)
    (sentence,) = sentences(store)
    assert record.name in sentence
    assert mend(store) == [f"forgot checkpoint {record.name} of run r1"]
    assert sentences(store) == []
    assert len(store.database.checkpoints("r1")) == 2
    assert not (store.folder.checkpoints("r1") / record.name).exists()


def test_files_without_rows_are_litter_and_are_removed(store: SmallStore) -> None:
    segment = segment_files(store.folder, "r2")[0]
    segment.write_bytes(segment.read_bytes() + b"torn tail")
    (store.folder.root / "frames" / "nobody").mkdir()
    shutil.copytree(
        store.folder.checkpoints("r1") / store.database.checkpoints("r1")[0].name,
        store.folder.checkpoints("r1") / "step9-0000",
    )
    found = sentences(store)
    assert len(found) == 3
    assert "9 bytes without a row" in " ".join(found)
    assert not list(find_faults(store.folder, store.database, with_litter=False))
    assert mend(store) == ["removed files without a row"]
    assert sentences(store) == []


def test_terrain_that_cannot_be_read_is_told_and_left(store: SmallStore) -> None:
    store.folder.terrain("f00d").write_bytes(b"not compressed")
    (sentence,) = sentences(store)
    assert "loading its case writes it again" in sentence
    assert mend(store) == []


def test_a_damaged_database_is_told(store: SmallStore) -> None:
    store.database.close()
    raw = sqlite3.connect(store.folder.database)
    raw.execute("PRAGMA foreign_keys = OFF")
    raw.execute("INSERT INTO edit_events VALUES ('ghost', 1, 'undo', x'')")
    raw.commit()
    raw.close()
    store.database.__init__(store.folder.database)  # type: ignore[misc]
    assert "table edit_events has a row without its run" in sentences(store)[0]
