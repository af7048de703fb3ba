import os
import re
import signal
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from solver_service.runs import Run, RunStatus
from tests.end_to_end.dam_break import write_dam_break
from tests.solver_service.runs.conftest import Service

DURATION = 400.0


def write_wild_case(folder: Path) -> Path:
    """Water that falls 8 km over cells of a millimetre: its time step collapses."""
    write_dam_break(folder, name="wild")
    case_file = folder / "case.toml"
    case_file.write_text(case_file.read_text().replace("cell_size = 10.0", "cell_size = 0.001"))
    terrain = dict(np.load(folder / "terrain.npz"))
    terrain["depth"][40:44, 40:44] = 900.0
    terrain["bed"][46:, :] -= 8000.0
    np.savez(folder / "terrain.npz", **terrain)
    return folder


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory, case: str) -> Iterator[Service]:
    wild = write_wild_case(tmp_path_factory.mktemp("case") / "wild")
    data_dir = tmp_path_factory.mktemp("data")
    service = Service(data_dir, cases=(case, str(wild)), threads=2, restart_attempts=2)
    yield service
    service.close()


def start(service: Service, paused: bool = False, duration: float = DURATION) -> Run:
    run = service.call(service.registry.control.start("dam-break", duration, paused=paused))
    service.wait(lambda: run.frame_count > 0)
    return run


def kill_worker(run: Run, number: int = signal.SIGKILL) -> None:
    assert run.worker is not None
    assert run.worker.pid is not None
    os.kill(run.worker.pid, number)


def packed_frames(service: Service, run: Run, count: int) -> list[bytes]:
    """The first frames of a run without its name."""
    packed = [service.call(service.registry.read_frame(frame)) for frame in run.frames[:count]]
    return [frame.partition(run.run.encode())[2] for frame in packed]


def test_a_death_is_noticed_and_told_within_a_tenth_of_a_second(service: Service) -> None:
    assert min(delay_of_a_death(service) for _ in range(2)) < 0.1


def delay_of_a_death(service: Service) -> float:
    run = start(service)
    begun = time.perf_counter()
    kill_worker(run)
    service.wait(lambda: bool(service.notices(run.run)))
    delay = time.perf_counter() - begun
    service.call(service.registry.control.stop(run.run))
    return delay


def test_a_run_that_dies_too_often_fails_in_words_and_a_person_can_resume_it(service: Service) -> None:
    run = start(service)
    for attempt in (1, 2, 3):
        service.wait(lambda: run.worker is not None and run.status is RunStatus.RUNNING)
        kill_worker(run)
        service.wait(lambda attempt=attempt: len(service.notices(run.run)) == attempt)
    assert [text.rpartition("(")[2] for text in service.notices(run.run)[:2]] == [
        "restart 1 of 2)",
        "restart 2 of 2)",
    ]
    assert run.status is RunStatus.FAILED
    assert "killed (SIGKILL)" in run.reason
    service.call(service.registry.control.resume(run.run))
    service.wait_for_status(run, RunStatus.FINISHED)
    assert [frame.index for frame in run.frames] == list(range(81))


def test_a_run_that_blows_up_fails_with_time_and_cell_and_is_not_tried_again(service: Service) -> None:
    run = service.call(service.registry.control.start("wild"))
    service.wait_for_status(run, RunStatus.FAILED)
    service.wait(lambda: bool(service.notices(run.run)))
    assert "The run stopped at" in run.reason
    assert "cell (row" in run.reason
    assert service.statuses(run.run).count("starting") == 1
    assert len(service.notices(run.run)) == 1


def test_a_worker_that_gets_no_memory_ends_in_words_and_another_goes_on_while_neighbours_do_not_notice(
    service: Service,
) -> None:
    resource = pytest.importorskip("resource")
    neighbour = start(service)
    run = start(service, paused=True)
    service.wait_for_status(run, RunStatus.PAUSED)
    assert run.worker is not None
    assert run.worker.pid is not None
    size = int(Path(f"/proc/{run.worker.pid}/statm").read_text().split()[0]) * resource.getpagesize()
    resource.prlimit(run.worker.pid, resource.RLIMIT_AS, (size, size))
    service.call(service.registry.control.resume(run.run))
    service.wait(lambda: bool(service.notices(run.run)))
    # Python raises MemoryError; native code that gets nothing mostly crashes
    assert re.search(r"ran out of memory|crashed \(SIG(SEGV|ABRT)\)", service.notices(run.run)[0])
    service.wait_for_status(run, RunStatus.FINISHED)
    service.wait_for_status(neighbour, RunStatus.FINISHED)
    assert service.statuses(neighbour.run) == ["starting", "running", "finished"]
    for ours, theirs in zip(run.frames, neighbour.frames, strict=True):
        ours_packed, theirs_packed = (service.call(service.registry.read_frame(f)) for f in (ours, theirs))
        assert (
            ours_packed.partition(run.run.encode())[2] == theirs_packed.partition(neighbour.run.encode())[2]
        )


def test_a_crash_a_kill_and_a_blow_up_beside_a_run_leave_its_frames_unchanged(service: Service) -> None:
    control = service.registry.control
    neighbour = service.call(control.start("dam-break", 1e5))
    crashed, killed = start(service, duration=1e5), start(service, duration=1e5)
    kill_worker(crashed, signal.SIGSEGV)
    kill_worker(killed, signal.SIGKILL)
    wild = service.call(control.start("wild"))
    service.wait_for_status(wild, RunStatus.FAILED)
    service.wait(lambda: bool(service.notices(crashed.run)) and bool(service.notices(killed.run)))
    assert "crashed (SIGSEGV)" in service.notices(crashed.run)[0]
    assert "killed (SIGKILL)" in service.notices(killed.run)[0]
    for run in (neighbour, crashed, killed):
        service.call(control.stop(run.run))
    service.call(service.registry.supervisor.settle(neighbour))
    assert service.statuses(neighbour.run) == ["starting", "running", "stopped"], "it noticed nothing"
    count = neighbour.frame_count
    truth = service.call(control.start("dam-break", 5.0 * (count - 1)))
    service.wait_for_status(truth, RunStatus.FINISHED)
    assert packed_frames(service, neighbour, count) == packed_frames(service, truth, count)
