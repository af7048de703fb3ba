"""Why a run or its worker cannot go on, told from an exception or from how a process ended, in words."""

from __future__ import annotations

import signal
from enum import StrEnum

from solver_service.errors import DeviceError, ServiceError, SolverBlowUp


class FailureKind(StrEnum):
    """What went wrong; decides whether another worker may try again."""

    KILLED = "killed"
    HUNG = "hung"
    OUT_OF_MEMORY = "out_of_memory"
    DEVICE = "device"
    CRASHED = "crashed"
    BLOW_UP = "blow_up"
    REFUSED = "refused"


RETRIED = frozenset(
    {
        FailureKind.KILLED,
        FailureKind.HUNG,
        FailureKind.OUT_OF_MEMORY,
        FailureKind.DEVICE,
        FailureKind.CRASHED,
    }
)
"""What may be gone at the next attempt; the same computation would blow up, or be refused, again."""

_MEMORY_SIGNS = ("failed to allocate", "out of memory", "cannot allocate memory", "bad_alloc")
_DEVICE_SIGNS = ("cuda", "cudnn", "nvrtc", "device")
LONGEST_CAUSE = 500


def failure_of(error: BaseException) -> tuple[FailureKind, str]:
    """What an exception of the computation means.

    Args:
        error: what was raised.

    Returns:
        The kind, and a clause for people without a full stop.
    """
    text = (str(error).strip() or type(error).__name__)[:LONGEST_CAUSE]
    signs = text.lower()
    if isinstance(error, SolverBlowUp):
        return FailureKind.BLOW_UP, text.rstrip(".")
    if isinstance(error, MemoryError) or any(sign in signs for sign in _MEMORY_SIGNS):
        return FailureKind.OUT_OF_MEMORY, f"the worker ran out of memory ({text})"
    if isinstance(error, ServiceError) and not isinstance(error, DeviceError):
        return FailureKind.REFUSED, text.rstrip(".")
    if isinstance(error, DeviceError) or any(sign in signs for sign in _DEVICE_SIGNS):
        return FailureKind.DEVICE, f"the device failed ({text})"
    return FailureKind.CRASHED, f"the worker failed with {type(error).__name__}: {text}"


def failure_of_exit(code: int | None) -> tuple[FailureKind, str]:
    """What the end of a process that told nothing means.

    Args:
        code: its exit status; below 0 the signal that ended it.
    """
    if code is not None and code < 0:
        name = _signal_name(-code)
        if name == "SIGKILL":
            return FailureKind.KILLED, (
                "its worker process was killed (SIGKILL), by a person or by the system for lack of memory"
            )
        if name in ("SIGTERM", "SIGINT", "SIGHUP", "SIGQUIT"):
            return FailureKind.KILLED, f"its worker process was ended from outside ({name})"
        return FailureKind.CRASHED, f"its worker process crashed ({name})"
    return FailureKind.CRASHED, f"its worker process ended unexpectedly (status {code})"


def _signal_name(number: int) -> str:
    try:
        return signal.Signals(number).name
    except ValueError:
        return f"signal {number}"
