import signal

import pytest

from solver_service.errors import DeviceError, ServiceError, SolverBlowUp, StoreError
from solver_service.runs.worker_failure import RETRIED, FailureKind, failure_of, failure_of_exit

BLOW_UP = SolverBlowUp(12.5, 3, 4, "h is nan m", "likely a bed value")


@pytest.mark.parametrize(
    ("error", "kind", "words"),
    [
        (BLOW_UP, FailureKind.BLOW_UP, "h is nan m"),
        (MemoryError(), FailureKind.OUT_OF_MEMORY, "ran out of memory"),
        (
            RuntimeError("Failed to allocate 160000 bytes on device 'cuda:0'"),
            FailureKind.OUT_OF_MEMORY,
            "ran out of memory",
        ),
        (RuntimeError("CUDA error 700: an illegal memory access"), FailureKind.DEVICE, "the device failed"),
        (DeviceError("The device 'cuda:9' is not there."), FailureKind.DEVICE, "cuda:9"),
        (StoreError("the bed cannot be written"), FailureKind.REFUSED, "the bed cannot be written"),
        (ServiceError("case x has changed"), FailureKind.REFUSED, "case x has changed"),
        (KeyError("h"), FailureKind.CRASHED, "failed with KeyError: 'h'"),
    ],
)
def test_an_exception_has_its_kind_and_its_words(error: Exception, kind: FailureKind, words: str) -> None:
    found, sentence = failure_of(error)
    assert found is kind
    assert words in sentence
    assert not sentence.endswith(".")


@pytest.mark.parametrize(
    ("code", "kind", "words"),
    [
        (-signal.SIGKILL, FailureKind.KILLED, "SIGKILL"),
        (-signal.SIGTERM, FailureKind.KILLED, "SIGTERM"),
        (-signal.SIGSEGV, FailureKind.CRASHED, "SIGSEGV"),
        (-99, FailureKind.CRASHED, "signal 99"),
        (3, FailureKind.CRASHED, "status 3"),
        (None, FailureKind.CRASHED, "unexpectedly"),
    ],
)
def test_the_end_of_a_silent_process_has_its_kind_and_its_words(
    code: int | None, kind: FailureKind, words: str
) -> None:
    found, sentence = failure_of_exit(code)
    assert found is kind
    assert words in sentence


def test_what_would_come_again_is_not_retried() -> None:
    assert set(FailureKind) - RETRIED == {FailureKind.BLOW_UP, FailureKind.REFUSED}


def test_a_long_cause_is_cut() -> None:
    assert len(failure_of(RuntimeError("x" * 100_000))[1]) < 1000
