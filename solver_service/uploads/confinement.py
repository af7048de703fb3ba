"""Confining a process before it opens a file that may be hostile.

Resource limits bound memory, processor time, files and their sizes. A seccomp filter, which no later code of
the process can lift, refuses sockets, new processes, signals to others and tracing: what a file reader that
was taken over would need (seccomp(2), BPF instructions in linux/filter.h). GDAL is left with the few drivers
that are asked for by name.
"""

from __future__ import annotations

import ctypes
import os
import platform
import struct
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from errno import ENOSYS, EPERM

from solver_service.errors import CaseError
from solver_service.uploads.import_messages import ImportLimits

NICENESS = 15
OPEN_FILES = 128

_PR_SET_PDEATHSIG, _PR_SET_NO_NEW_PRIVS, _PR_SET_SECCOMP = 1, 38, 22
_SECCOMP_MODE_FILTER, _SIGKILL = 2, 9
_ALLOW, _ERROR = 0x7FFF0000, 0x00050000
_LOAD, _JUMP_IF_EQUAL, _JUMP_IF_AT_LEAST, _JUMP_IF_ANY_BIT, _RETURN = 0x20, 0x15, 0x35, 0x45, 0x06
_MACHINE_AT, _NUMBER_AT, _FIRST_ARGUMENT_AT = 4, 0, 16  # in the seccomp_data that a filter sees
_X32_CALLS = 0x40000000
"""System calls from here on are those of another interface of x86-64."""
_CLONE_THREAD = 0x10000


@dataclass(frozen=True)
class CallTable:
    """The numbers of a machine.

    Attributes:
        machine: its number in the kernel's audit interface.
        clone: the call that makes a thread, which is allowed, or a process, which is not.
        clone3: the same with arguments that a filter cannot see; the C library goes back to `clone`.
        refused: calls that are refused, by name.
    """

    machine: int
    clone: int
    clone3: int
    refused: dict[str, int]


CALLS = {
    "x86_64": CallTable(
        0xC000003E,
        56,
        435,
        {
            "socket": 41,
            "connect": 42,
            "bind": 49,
            "listen": 50,
            "socketpair": 53,
            "fork": 57,
            "vfork": 58,
            "execve": 59,
            "kill": 62,
            "ptrace": 101,
            "mount": 165,
            "tkill": 200,
            "tgkill": 234,
            "unshare": 272,
            "setns": 308,
            "process_vm_readv": 310,
            "process_vm_writev": 311,
            "bpf": 321,
            "execveat": 322,
            "pidfd_send_signal": 424,
            "io_uring_setup": 425,
            "pidfd_getfd": 438,
        },
    ),
    "aarch64": CallTable(
        0xC00000B7,
        220,
        435,
        {
            "mount": 40,
            "unshare": 97,
            "ptrace": 117,
            "kill": 129,
            "tkill": 130,
            "tgkill": 131,
            "socket": 198,
            "socketpair": 199,
            "bind": 200,
            "listen": 201,
            "connect": 203,
            "execve": 221,
            "setns": 268,
            "process_vm_readv": 270,
            "process_vm_writev": 271,
            "bpf": 280,
            "execveat": 281,
            "pidfd_send_signal": 424,
            "io_uring_setup": 425,
            "pidfd_getfd": 438,
        },
    ),
}

GDAL = {
    "GDAL_SKIP": "VRT,MRF,netCDF,HDF4,HDF5,HDF5Image,WMS,WMTS,WCS,HTTP,PLMOSAIC,STACIT,STACTA,GTI,DERIVED,"
    "MEM,Zarr,PDF,Rasterlite,SQLite,GPKG,MBTiles,OGCAPI,EEDA,EEDAI,DAAS,NGW,GRASSASCIIGrid,KMLSUPEROVERLAY",
    "GDAL_DISABLE_READDIR_ON_OPEN": "EMPTY_DIR",
    "GDAL_PAM_ENABLED": "NO",
    "GDAL_CACHEMAX": "64",
    "GDAL_NUM_THREADS": "1",
    "GDAL_HTTP_MAX_RETRY": "0",
    "PROJ_NETWORK": "OFF",
}
PASSED_ON = ("PATH", "HOME", "LANG", "LC_ALL", "PYTHONPATH", "WARP_CACHE_PATH", "XDG_CACHE_HOME")
"""Variables of the service that a confined process has too: no token, no proxy, no setting."""


def confined_environment(environment: Mapping[str, str], temporary: str) -> dict[str, str]:
    """The variables of a confined process.

    Args:
        environment: those of the service, of which few are passed on.
        temporary: its folder for temporary files.
    """
    kept = {name: environment[name] for name in PASSED_ON if name in environment}
    one = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "MALLOC_ARENA_MAX": "2"}
    return {**kept, **one, **GDAL, "CUDA_VISIBLE_DEVICES": "", "TMPDIR": temporary}


def confine(limits: ImportLimits, parent: int) -> None:
    """Confine this process for good; to be called before any thread is started.

    Args:
        limits: what it may take.
        parent: id of the process that started it; this one ends with that one.

    Raises:
        CaseError: this system cannot confine a process.
    """
    calls = CALLS.get(platform.machine())
    if sys.platform != "linux" or calls is None:
        raise CaseError(
            f"cases can be imported on Linux on {' and '.join(CALLS)} only; this is {sys.platform} on"
            f" {platform.machine()}"
        )
    import resource

    os.umask(0o077)
    os.nice(NICENESS)
    seconds = int(limits.time_s) + 1
    for kind, most in (
        (resource.RLIMIT_AS, limits.memory_bytes),
        (resource.RLIMIT_CPU, seconds),
        (resource.RLIMIT_FSIZE, limits.unpacked_bytes),
        (resource.RLIMIT_NOFILE, OPEN_FILES),
        (resource.RLIMIT_CORE, 0),
    ):
        _, hard = resource.getrlimit(kind)
        most = most if hard == resource.RLIM_INFINITY else min(most, hard)
        resource.setrlimit(kind, (most, most))
    _prctl(_PR_SET_PDEATHSIG, _SIGKILL)
    if os.getppid() != parent:
        sys.exit("the service that asked for this import is gone")
    _prctl(_PR_SET_NO_NEW_PRIVS, 1)
    _filter_calls(calls)


def filter_program(calls: CallTable) -> bytes:
    """The instructions of a filter that refuses calls by EPERM, or by ENOSYS where another call does as well.

    Args:
        calls: the numbers of this machine; calls for another one are refused.
    """
    refused = sorted(calls.refused.values())
    allow, refuse, absent = (len(refused) + 8 + verdict for verdict in range(3))
    lines: list[tuple[int, int, int, int]] = []

    def jump(code: int, constant: int, yes: int | None = None, no: int | None = None) -> None:
        """Go to a line, or on to the next."""
        here = len(lines) + 1
        lines.append((code, (yes or here) - here, (no or here) - here, constant))

    lines.append((_LOAD, 0, 0, _MACHINE_AT))
    jump(_JUMP_IF_EQUAL, calls.machine, no=refuse)
    lines.append((_LOAD, 0, 0, _NUMBER_AT))
    jump(_JUMP_IF_AT_LEAST, _X32_CALLS, yes=refuse)
    for number in refused:
        jump(_JUMP_IF_EQUAL, number, yes=refuse)
    jump(_JUMP_IF_EQUAL, calls.clone3, yes=absent)
    jump(_JUMP_IF_EQUAL, calls.clone, no=allow)
    lines.append((_LOAD, 0, 0, _FIRST_ARGUMENT_AT))
    jump(_JUMP_IF_ANY_BIT, _CLONE_THREAD, no=refuse)
    lines += [(_RETURN, 0, 0, verdict) for verdict in (_ALLOW, _ERROR | EPERM, _ERROR | ENOSYS)]
    return b"".join(struct.pack("<HBBI", *line) for line in lines)


def _filter_calls(calls: CallTable) -> None:
    program = filter_program(calls)
    held = ctypes.create_string_buffer(program, len(program))
    head = ctypes.create_string_buffer(
        struct.pack("@HP", len(program) // 8, ctypes.addressof(held)), struct.calcsize("@HP")
    )
    _prctl(_PR_SET_SECCOMP, _SECCOMP_MODE_FILTER, ctypes.addressof(head))


def _prctl(option: int, value: int, more: int = 0) -> None:
    """Call prctl(2).

    Raises:
        CaseError: the kernel refuses.
    """
    call = ctypes.CDLL(None, use_errno=True).prctl
    call.argtypes = [ctypes.c_int, *([ctypes.c_ulong] * 4)]
    if call(option, value, more, 0, 0) != 0:
        reason = os.strerror(ctypes.get_errno())
        raise CaseError(f"this system does not let a process confine itself (prctl {option}: {reason})")
