"""Whatever a crash or a disk does to one file, a reader gets the very bytes that were written, or is told.

Hypothesis chooses the file, where it is cut, which bit is turned over, or what stands there instead.
"""

import math
import shutil
from pathlib import Path
from typing import Any

import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings

from solver_service.errors import StoreError
from solver_service.store import CheckpointStore, DataFolder, FrameReader, RunDatabase, StoredState
from solver_service.store.frame_files import recover_segments, segment_files
from tests.solver_service.store.small_store import RUN, SmallStore

BOUNDED = settings(
    max_examples=60,
    deadline=None,
    database=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
)
PLACE = st.floats(0.0, 1.0, exclude_max=True)
DAMAGE = st.sampled_from(("cut", "flip", "zeros", "gone"))


def damage(path: Path, kind: str, place: float, bit: int) -> None:
    """Spoil a file at a place between its begin (0) and its end (1)."""
    content = bytearray(path.read_bytes())
    at = int(place * len(content))
    if kind == "gone":
        path.unlink()
        return
    if kind == "cut":
        del content[at:]
    elif kind == "flip" and content:
        content[at] ^= 1 << bit
    elif kind == "zeros":
        content[at:] = bytes(len(content) - at)
    path.write_bytes(content)


def content(state: StoredState) -> dict[str, Any]:
    """What a restart needs, to be compared bit for bit."""
    arrays = {name: (a.dtype, a.shape, a.tobytes()) for name, a in state.arrays.items()}
    return {"time": state.time, "step": state.step_count, "arrays": arrays, "scalars": dict(state.scalars)}


@pytest.fixture(scope="module")
def checkpoints(tmp_path_factory: pytest.TempPathFactory) -> tuple[DataFolder, list[StoredState]]:
    """A run with two checkpoints."""
    folder = DataFolder(tmp_path_factory.mktemp("checkpoints"))
    database = RunDatabase(folder.database)
    database.begin_epoch()
    database.insert_run(RUN)
    rng = np.random.default_rng(5)
    states = [
        StoredState(
            10.0 * k,
            7 * k,
            {"h": rng.random((20, 30)).astype(np.float32), "sums": rng.random(5), "dry": np.zeros((20, 30))},
            {"dt": 0.1 + 1e-17 * k, "never": math.inf, "steps": 2**53 + k},
        )
        for k in (1, 2)
    ]
    for state in states:
        CheckpointStore(folder, database).write("r1", state)
    database.close()
    return folder, states


@BOUNDED
@given(pick=PLACE, kind=DAMAGE, place=PLACE, bit=st.integers(0, 7))
def test_a_spoilt_checkpoint_is_never_taken_for_another_state(
    checkpoints: tuple[DataFolder, list[StoredState]], pick: float, kind: str, place: float, bit: int
) -> None:
    folder, (older, newer) = checkpoints
    database = RunDatabase(folder.database)
    path = folder.checkpoints("r1") / database.checkpoints("r1")[-1].name
    files = sorted(file for file in path.rglob("*") if file.is_file())
    victim = files[int(pick * len(files))]
    whole = victim.read_bytes()
    try:
        damage(victim, kind, place, bit)
        found, passed_over = CheckpointStore(folder, database).latest("r1", math.inf)
    finally:
        victim.write_bytes(whole)
        database.close()
    assert found is not None
    if passed_over:
        assert content(found) == content(older)
    else:
        assert content(found) == content(newer)


@pytest.fixture(scope="module")
def whole_store(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, list[bytes]]:
    """A store that is copied for every example, and the frames of its run r2."""
    root = tmp_path_factory.mktemp("frames") / "store"
    store = SmallStore(root)
    frames = store.frames("r2")
    store.database.close()
    return root, frames


@BOUNDED
@given(kind=DAMAGE, place=PLACE, bit=st.integers(0, 7))
def test_a_spoilt_segment_gives_the_frames_that_were_written_or_tells(
    whole_store: tuple[Path, list[bytes]], kind: str, place: float, bit: int
) -> None:
    root, frames = whole_store
    folder = DataFolder(root)
    (path,) = segment_files(folder, "r2")
    whole = path.read_bytes()
    database = RunDatabase(folder.database)
    reader = FrameReader(folder)
    told: dict[int, str] = {}
    try:
        damage(path, kind, place, bit)
        for record, frame in zip(database.frames("r2"), frames, strict=True):
            try:
                assert reader.read(record) == frame
            except StoreError as error:
                told[record.index] = str(error)
    finally:
        path.write_bytes(whole)
        database.close()
    assert all(f"frame {index} of run r2" in sentence for index, sentence in told.items())
    assert len(told) <= (1 if kind == "flip" else len(frames))


@BOUNDED
@given(tail=st.binary(min_size=1, max_size=300))
def test_whatever_a_crash_left_behind_the_last_frame_is_cut_and_no_frame_is_touched(
    whole_store: tuple[Path, list[bytes]], tmp_path: Path, tail: bytes
) -> None:
    root, frames = whole_store
    shutil.rmtree(tmp_path / "store", ignore_errors=True)
    shutil.copytree(root, tmp_path / "store")
    folder = DataFolder(tmp_path / "store")
    database = RunDatabase(folder.database)
    (path,) = segment_files(folder, "r2")
    with path.open("ab") as file:
        file.write(tail)
    assert recover_segments(folder, database, "r2") == len(tail)
    reader = FrameReader(folder)
    assert [reader.read(record) for record in database.frames("r2")] == frames
    database.close()
