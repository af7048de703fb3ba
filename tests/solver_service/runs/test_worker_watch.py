"""Hanging workers: the verdict by a clock of its own, and real processes that are stopped."""

import os
import signal
import time
from collections.abc import Iterator
from dataclasses import dataclass, field

import pytest

from solver_service.errors import RunError
from solver_service.runs import Patience, RunStatus
from solver_service.runs.worker_failure import RETRIED, FailureKind
from solver_service.runs.worker_watch import WorkerWatch
from tests.solver_service.runs.conftest import Service
from tests.solver_service.runs.test_registry import DURATION, assert_same_to_the_bit


@dataclass
class Process:
    """A worker of which only the signs are looked at."""

    pulse_at: float = 0.0
    advanced_at: float = 0.0
    has_pulse: bool = True
    is_ready: bool = True
    ends: list[tuple[FailureKind, str]] = field(default_factory=list)

    def give_up(self, kind: FailureKind, words: str) -> None:
        self.ends.append((kind, words))


def looked_at(worker: Process, until: float, signs: dict[str, bool]) -> Process:
    """A worker after a look each second, that shows some signs each second."""
    clock = [0.0]
    watch = WorkerWatch(lambda: [worker], Patience(silence_s=30.0, stall_s=600.0), lambda: clock[0])
    while clock[0] < until and not worker.ends:
        clock[0] += 1.0
        for sign in signs:
            setattr(worker, sign, clock[0])
        watch.look(1.0)
    return worker


@pytest.mark.parametrize(
    ("worker", "signs", "until", "words"),
    [
        (Process(), [], 30.0, None),
        (Process(), [], 31.0, "gave no sign for 31 s"),
        (Process(), ["pulse_at"], 600.0, None),  # one long step, or a compilation
        (Process(), ["pulse_at"], 601.0, "did one and the same thing for 601 s"),
        (Process(), ["pulse_at", "advanced_at"], 5000.0, None),
        (Process(is_ready=False), ["pulse_at"], 5000.0, None),  # it compiles its kernels
        (Process(is_ready=False), [], 31.0, "gave no sign"),
        (Process(has_pulse=False, is_ready=False), [], 120.0, None),  # it is still importing
        (Process(has_pulse=False, is_ready=False), [], 121.0, "gave no sign"),
    ],
)
def test_a_worker_is_ended_when_it_shows_nothing_for_longer_than_allowed(
    worker: Process, signs: dict[str, bool], until: float, words: str | None
) -> None:
    looked_at(worker, until, signs)
    if words is None:
        assert worker.ends == []
    else:
        ((kind, told),) = worker.ends
        assert kind is FailureKind.HUNG
        assert words in told


def test_a_service_that_was_held_up_itself_blames_no_worker() -> None:
    clock = [0.0]
    worker = Process()
    watch = WorkerWatch(lambda: [worker], Patience(30.0, 600.0), lambda: clock[0])
    clock[0] = 100.0  # the machine slept; pulses wait in the pipes
    watch.look(1.0)
    for _ in range(30):
        clock[0] += 1.0
        watch.look(1.0)
    assert worker.ends == []
    clock[0] += 1.0
    watch.look(1.0)
    assert len(worker.ends) == 1


def test_a_run_whose_worker_hangs_may_be_taken_up_again() -> None:
    assert FailureKind.HUNG in RETRIED


@pytest.fixture(scope="module")
def impatient(tmp_path_factory: pytest.TempPathFactory, case: str) -> Iterator[Service]:
    folder = tmp_path_factory.mktemp("data")
    service = Service(
        folder,
        cases=(case,),
        threads=2,
        checkpoint_interval_s=0.02,
        patience=Patience(silence_s=3.0, stall_s=3.0),
    )
    yield service
    service.close()


def test_a_worker_that_is_stopped_is_told_and_another_goes_on_with_the_very_bytes_beside_one_that_waits(
    impatient: Service,
) -> None:
    waiting = impatient.call(impatient.registry.control.start("dam-break", DURATION, paused=True))
    impatient.wait(lambda: waiting.status is RunStatus.PAUSED)
    idle, waits_since = waiting.worker, time.monotonic()
    truth = impatient.call(impatient.registry.control.start("dam-break", DURATION))
    impatient.wait_for_status(truth, RunStatus.FINISHED)
    run = impatient.call(impatient.registry.control.start("dam-break", DURATION))
    impatient.wait(lambda: run.frame_count > 5)
    assert run.worker is not None
    assert run.worker.pid is not None
    frozen = run.worker
    os.kill(run.worker.pid, signal.SIGSTOP)
    begun = time.monotonic()
    impatient.wait(lambda: bool(impatient.notices(run.run)))
    assert 1.0 < time.monotonic() - begun < 30.0
    assert "its worker process gave no sign for" in impatient.notices(run.run)[0]
    assert "going on from the last checkpoint (restart 1 of 3)" in impatient.notices(run.run)[0]
    assert frozen.is_dead
    assert_same_to_the_bit(impatient, run, truth)
    time.sleep(max(waits_since + 3.5 - time.monotonic(), 0.0))
    assert idle is not None
    assert not idle.is_dead  # it waits for orders, for longer than anybody may do one and the same thing
    assert impatient.notices(waiting.run) == []
    impatient.call(impatient.registry.control.stop(waiting.run))


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="a file that blocks needs POSIX")
def test_a_solver_thread_that_stands_still_is_told_although_its_process_lives(impatient: Service) -> None:
    registry = impatient.registry
    first = next(iter(registry.tree))
    bed = registry._folder.terrain(first.record.case_fingerprint)
    bed.unlink()
    impatient.wait(lambda: any(each.is_ready and each.run is None for each in registry.pool.workers))
    for worker in registry.pool.workers:  # whoever writes the bed again waits for a reader for ever
        os.mkfifo(bed.with_name(f"{bed.name}.{worker.pid}.writing"))
    begun = time.monotonic()
    with pytest.raises(RunError, match="nothing was done: its worker did one and the same thing for"):
        impatient.call(registry.control.start("dam-break", DURATION))
    assert time.monotonic() - begun > 2.0
