import math
import os
import signal
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from protocol import CHANNEL_NAMES
from solver_service.errors import RunError, StoreError
from solver_service.runs import Run, RunRegistry, RunStatus
from solver_service.store import CheckpointStore, DataFolder, RunDatabase, StoredState
from tests.end_to_end.dam_break import levee, write_dam_break
from tests.solver_service.runs.conftest import Service

DURATION = 400.0
LAST = 80


def packed_frames(service: Service, run: Run) -> list[bytes]:
    return [service.call(service.registry.read_frame(frame)) for frame in run.frames]


def last_state(service: Service, run: Run) -> StoredState | None:
    """The last checkpoint of a run, read from the disk as another process would."""
    folder = service.registry._folder
    database = RunDatabase(folder.database)
    try:
        found, damaged = CheckpointStore(folder, database).latest(run.run, math.inf)
    finally:
        database.close()
    assert damaged == []
    return found


def final_state(service: Service, run: Run) -> StoredState:
    """The state at the end; the last checkpoint is written behind the last frame."""

    def is_there() -> bool:
        found = last_state(service, run)
        return found is not None and found.time == DURATION

    wait_until(is_there)
    found = last_state(service, run)
    assert found is not None
    return found


def wait_until(test: Callable[[], bool]) -> None:
    ends = time.monotonic() + 20.0
    while not test():
        assert time.monotonic() < ends, "it did not come"
        time.sleep(0.02)


def assert_same_to_the_bit(service: Service, run: Run, truth: Run) -> None:
    service.wait_for_status(run, RunStatus.FINISHED)
    for ours, theirs in zip(packed_frames(service, run), packed_frames(service, truth), strict=True):
        assert ours.partition(run.run.encode())[2] == theirs.partition(truth.run.encode())[2]
    for index in range(0, LAST + 1, 4):
        for name in CHANNEL_NAMES:
            ours, theirs = (
                service.call(service.registry.channels.read(each.run, index, name)) for each in (run, truth)
            )
            assert ours.partition(run.run.encode())[2] == theirs.partition(truth.run.encode())[2]
    states = [final_state(service, each) for each in (run, truth)]
    assert states[0].step_count == states[1].step_count
    assert states[0].scalars == states[1].scalars
    for name, array in states[1].arrays.items():
        assert states[0].arrays[name].tobytes() == array.tobytes(), name


@pytest.fixture(scope="module")
def truth(service: Service) -> Run:
    """A run that nothing disturbed."""
    run = service.call(service.registry.control.start("dam-break", DURATION))
    service.wait_for_status(run, RunStatus.FINISHED)
    return run


def test_a_run_goes_from_starting_to_finished_with_every_frame(service: Service, truth: Run) -> None:
    assert [frame.index for frame in truth.frames] == list(range(LAST + 1))
    assert service.statuses(truth.run) == ["starting", "running", "finished"]


def test_a_run_whose_worker_is_killed_goes_on_by_itself_in_words_with_the_very_bytes_of_another(
    service: Service, truth: Run
) -> None:
    neighbour = service.call(service.registry.control.start("dam-break", DURATION))
    run = service.call(service.registry.control.start("dam-break", DURATION))
    service.wait(lambda: run.frame_count > 5)
    assert run.status is RunStatus.RUNNING
    assert run.worker is not None
    assert run.worker.pid is not None
    os.kill(run.worker.pid, signal.SIGKILL)
    service.wait(lambda: bool(service.notices(run.run)))
    assert "killed (SIGKILL)" in service.notices(run.run)[0]
    assert "(restart 1 of 3)" in service.notices(run.run)[0]
    assert_same_to_the_bit(service, run, truth)
    assert_same_to_the_bit(service, neighbour, truth)
    assert service.statuses(run.run) == ["starting", "running", "starting", "running", "finished"]
    assert service.statuses(neighbour.run) == ["starting", "running", "finished"]


def test_pausing_again_and_again_changes_nothing(service: Service, truth: Run) -> None:
    run = service.call(service.registry.control.start("dam-break", DURATION))
    for count in (2, 5, 9):
        service.wait(lambda count=count: run.frame_count > count)
        if run.status is RunStatus.RUNNING:
            service.call(service.registry.control.pause(run.run))
            assert run.status is RunStatus.PAUSED
            service.call(service.registry.control.resume(run.run))
    assert_same_to_the_bit(service, run, truth)


def test_a_branch_that_crosses_two_branch_points_from_time_zero_equals_the_warm_one(
    service: Service,
) -> None:
    registry = service.registry
    root = service.call(registry.control.start("dam-break", DURATION))
    service.wait_for_status(root, RunStatus.FINISHED)
    service.call(registry.edits.append(root.run, levee("a", y=350.0)))
    child = service.call(registry.branching.recalculate(root.run, 6, 1))
    service.wait(lambda: child.frame_count > 12)
    service.call(registry.edits.append(child.run, levee("b", y=500.0)))
    warm = service.call(registry.branching.recalculate(child.run, 11, 2))
    service.wait_for_status(warm, RunStatus.FINISHED)
    final_state(service, warm)
    folder = DataFolder(registry._folder.root)
    for run in (root, child, warm):
        for path in folder.checkpoints(run.run).iterdir():
            for file in path.rglob("c/**/*"):
                if file.is_file():
                    file.write_bytes(b"torn")
    # no memory and no checkpoint of the lineage is left: the branch is computed from the case alone
    workers = [worker for worker in registry.pool.workers if worker.run is not None]
    for worker in workers:
        worker.kill()
    wait_until(lambda: all(worker.is_dead for worker in workers))
    cold = service.call(registry.branching.recalculate(warm.run, 11, 2))
    service.wait_for_status(cold, RunStatus.FINISHED)
    assert cold.record.parent == child.run
    assert any("is damaged" in text or "cannot be read" in text for text in service.notices(cold.run))
    for ours, theirs in zip(packed_frames(service, cold), packed_frames(service, warm), strict=True):
        assert ours.partition(cold.run.encode())[2] == theirs.partition(warm.run.encode())[2]


def test_a_run_whose_disk_is_full_pauses_in_words_and_goes_on_by_itself_when_there_is_room(
    service: Service, truth: Run
) -> None:
    resource = pytest.importorskip("resource")
    run = service.call(service.registry.control.start("dam-break", DURATION, paused=True))
    service.wait(lambda: run.status is RunStatus.PAUSED and run.frame_count == 1)
    assert run.worker is not None
    assert run.worker.pid is not None
    unlimited = resource.prlimit(run.worker.pid, resource.RLIMIT_FSIZE)
    segment = service.registry._folder.frames(run.run) / run.frames[0].segment
    limit = segment.stat().st_size + 10_000
    resource.prlimit(run.worker.pid, resource.RLIMIT_FSIZE, (limit, unlimited[1]))
    service.call(service.registry.control.resume(run.run))
    service.wait(lambda: bool(service.notices(run.run)))
    told = service.notices(run.run)[0]
    assert told.startswith("paused: ")
    assert "cannot be stored" in told or "store" in told
    stored = run.frame_count
    assert stored <= LAST
    resource.prlimit(run.worker.pid, resource.RLIMIT_FSIZE, unlimited)
    assert_same_to_the_bit(service, run, truth)
    assert "paused" in service.statuses(run.run)[2:]


def test_a_case_that_is_not_offered_is_refused_even_if_it_is_a_path_that_exists(
    service: Service, tmp_path: Path
) -> None:
    secret = write_dam_break(tmp_path / "secret", name="secret")
    with pytest.raises(RunError, match="there is no case"):
        service.call(service.registry.control.start(str(secret)))


def test_a_second_registry_on_the_same_folder_is_refused(service: Service) -> None:
    with pytest.raises(StoreError, match="in use by another service"):
        RunRegistry(service.registry._folder.root)
