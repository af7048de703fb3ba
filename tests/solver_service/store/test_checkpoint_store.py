import math
import os
import random
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from solver_service.errors import StoreError
from solver_service.store import CheckpointStore, DataFolder, RunDatabase, RunRecord, StoredState
from solver_service.store.checkpoint_store import remove_orphans

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


@pytest.fixture
def store(folder: DataFolder, database: RunDatabase) -> CheckpointStore:
    return CheckpointStore(folder, database)


def state(time: float, rng: np.random.Generator) -> StoredState:
    arrival = rng.random((40, 30)).astype(np.float32)
    arrival[3, 4] = np.nan
    arrays = {"h": rng.random((40, 30)).astype(np.float32), "arrival": arrival, "sums": rng.random(7)}
    scalars = {"dt": 0.1 + 1e-17, "tiny": math.nextafter(0.0, 1.0), "steps": 2**53 + 1, "never": math.inf}
    return StoredState(time, round(10 * time), arrays, scalars)


def assert_equal_to_the_bit(a: StoredState | None, b: StoredState) -> None:
    assert a is not None
    assert (a.time, a.step_count) == (b.time, b.step_count)
    assert dict(a.scalars) == dict(b.scalars)
    assert {type(value) for value in a.scalars.values()} == {type(value) for value in b.scalars.values()}
    assert sorted(a.arrays) == sorted(b.arrays)
    for name, array in b.arrays.items():
        assert a.arrays[name].dtype == array.dtype
        assert a.arrays[name].tobytes() == array.tobytes()


def test_a_state_comes_back_bit_for_bit(store: CheckpointStore, rng: np.random.Generator) -> None:
    written = state(12.5, rng)
    record = store.write("r1", written)
    assert_equal_to_the_bit(store.read(record), written)


def test_the_newest_at_or_before_a_time_is_found(store: CheckpointStore, rng: np.random.Generator) -> None:
    states = [state(time, rng) for time in (10.0, 20.0, 30.0)]
    for written in states:
        store.write("r1", written)
    assert_equal_to_the_bit(store.latest("r1", 29.9)[0], states[1])
    assert_equal_to_the_bit(store.latest("r1", math.inf)[0], states[2])
    assert store.latest("r1", 9.9) == (None, [])


def test_the_first_and_the_newest_stay_and_the_folders_of_the_others_are_gone(
    folder: DataFolder, database: RunDatabase, rng: np.random.Generator
) -> None:
    store = CheckpointStore(folder, database, keep=2)
    for time in range(1, 6):
        store.write("r1", state(float(time), rng))
    assert [record.time for record in database.checkpoints("r1")] == [1.0, 4.0, 5.0]
    assert len(list(folder.checkpoints("r1").iterdir())) == 3


@pytest.mark.parametrize("seed", range(8))
def test_a_torn_checkpoint_is_detected_and_the_one_before_is_used(
    store: CheckpointStore, folder: DataFolder, rng: np.random.Generator, seed: int
) -> None:
    good = state(10.0, rng)
    store.write("r1", good)
    record = store.write("r1", state(20.0, rng))
    chance = random.Random(seed)
    path = folder.checkpoints("r1") / record.name
    chunks = sorted(file for file in path.rglob("*") if file.is_file() and file.name != "zarr.json")
    victim = chance.choice(chunks)
    content = bytearray(victim.read_bytes())
    if seed % 2:
        victim.write_bytes(content[: chance.randrange(len(content))])
    else:
        content[chance.randrange(len(content))] ^= 1 << chance.randrange(8)
        victim.write_bytes(content)
    found, passed_over = store.latest("r1", math.inf)
    assert_equal_to_the_bit(found, good)
    assert len(passed_over) == 1
    assert record.name in passed_over[0]


def test_a_failed_write_leaves_no_row_and_no_folder(
    store: CheckpointStore,
    folder: DataFolder,
    database: RunDatabase,
    rng: np.random.Generator,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def no_space(path: Path) -> None:
        raise OSError(28, os.strerror(28))

    monkeypatch.setattr("solver_service.store.checkpoint_store.fsync_file", no_space)
    with pytest.raises(StoreError, match="No space left"):
        store.write("r1", state(1.0, rng))
    assert database.checkpoints("r1") == []
    assert list(folder.checkpoints("r1").iterdir()) == []


def test_folders_without_a_row_are_swept_after_a_crash(
    store: CheckpointStore, folder: DataFolder, database: RunDatabase, rng: np.random.Generator
) -> None:
    record = store.write("r1", state(1.0, rng))
    path = folder.checkpoints("r1")
    (path / "step7-0000").mkdir()
    (path / "step9-0000.writing").mkdir()
    folder.remove_unfinished()
    assert remove_orphans(folder, database, "r1") == 1
    assert [file.name for file in path.iterdir()] == [record.name]


def test_the_only_copy_is_never_overwritten(store: CheckpointStore, rng: np.random.Generator) -> None:
    first = state(5.0, rng)
    again = replace(first, arrays={**first.arrays, "h": np.zeros((40, 30), np.float32)})
    records = [store.write("r1", first), store.write("r1", again)]
    assert_equal_to_the_bit(store.read(records[0]), first)
    assert_equal_to_the_bit(store.read(records[1]), again)
