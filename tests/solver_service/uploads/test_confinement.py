"""What a confined process can no longer do, each shown in a real process."""

import os
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

import pytest

from solver_service.uploads.confinement import CALLS, confined_environment, filter_program
from solver_service.uploads.import_messages import ImportLimits
from tests.solver_service.uploads.confined import HEAD, run_confined

pytestmark = pytest.mark.skipif(
    sys.platform != "linux" or os.uname().machine not in CALLS,
    reason="processes are confined on Linux on x86-64 and aarch64",
)

ATTEMPTS = """
import socket, subprocess, signal, asyncio
attempt("file", lambda: open("/proc/self/status").read())
attempt("socket", lambda: socket.socket())
attempt("pair", lambda: socket.socketpair())
attempt("program", lambda: os.execv("/bin/true", ["true"]))
attempt("fork", os.fork)
import threading
thread = threading.Thread(target=lambda: print("thread done", flush=True))
thread.start()
thread.join()
attempt("child", lambda: subprocess.run(["/bin/true"]))
attempt("signal", lambda: os.kill(os.getppid(), 0))
"""


def test_sockets_processes_and_signals_are_refused_and_files_and_threads_are_not() -> None:
    answer = run_confined(ATTEMPTS)

    told = dict(line.split() for line in answer.stdout.splitlines())
    assert told.pop("file") == told.pop("thread") == "done"
    names = ("socket", "pair", "program", "fork", "child", "signal")
    assert told == dict.fromkeys(names, "PermissionError"), answer.stderr


def test_a_process_that_is_not_confined_may_do_what_is_refused() -> None:
    with socket.socket():
        os.kill(os.getpid(), 0)
    assert subprocess.run(["/bin/true"], check=False).returncode == 0


def test_memory_beyond_the_limit_is_a_memory_error() -> None:
    snippet = "\ntry:\n    bytearray(1 << 30)\nexcept MemoryError:\n    print('refused')"

    assert run_confined(snippet, ImportLimits(memory_bytes=512 << 20)).stdout == "refused\n"
    assert run_confined(snippet, ImportLimits(memory_bytes=4 << 30)).stdout == ""


def test_a_file_beyond_the_limit_is_refused(tmp_path: Path) -> None:
    snippet = f"""
import signal
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
def write():
    with open({str(tmp_path / "large")!r}, "wb") as file:
        for _ in range(8):
            file.write(bytes(1 << 20)); file.flush()
attempt("write", write)
"""
    answer = run_confined(snippet, ImportLimits(unpacked_bytes=3 << 20))

    assert answer.stdout == "write OSError\n"
    assert (tmp_path / "large").stat().st_size == 3 << 20
    assert (tmp_path / "large").stat().st_mode & 0o077 == 0


def test_processor_time_beyond_the_limit_ends_the_process() -> None:
    answer = run_confined("\nwhile True: pass", ImportLimits(time_s=0.0))

    assert answer.returncode in (-signal.SIGXCPU, -signal.SIGKILL)


def test_a_confined_process_ends_with_the_one_that_started_it(tmp_path: Path) -> None:
    inner = (
        HEAD.replace("sys.argv[1]", repr("{}"))
        + "\nimport time\nprint(os.getpid(), flush=True)\ntime.sleep(60)"
    )
    outer = (
        "import subprocess, sys, time\n"
        f"child = subprocess.Popen([sys.executable, '-c', {inner!r}], stdout=subprocess.PIPE, text=True)\n"
        "print(child.stdout.readline().strip(), flush=True)\ntime.sleep(60)"
    )
    parent = subprocess.Popen([sys.executable, "-c", outer], stdout=subprocess.PIPE, text=True)
    assert parent.stdout is not None
    child = int(parent.stdout.readline())
    parent.kill()
    parent.wait()
    parent.stdout.close()

    ends = time.monotonic() + 10.0
    while _lives(child):
        assert time.monotonic() < ends
        time.sleep(0.02)


def _lives(pid: int) -> bool:
    try:
        state = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0]
    except FileNotFoundError:
        return False
    return state != "Z"


def test_few_variables_reach_the_process_and_gdal_has_lost_the_drivers_that_read_other_files() -> None:
    found = confined_environment({"PATH": "/bin", "FEV_TOKEN": "secret", "https_proxy": "http://x"}, "/tmp/t")

    assert "secret" not in found.values()
    assert "https_proxy" not in found
    assert found["TMPDIR"] == "/tmp/t"
    assert {"VRT", "MRF", "netCDF", "WMS", "HTTP"} <= set(found["GDAL_SKIP"].split(","))


def test_every_jump_of_the_filter_lands_on_its_verdict() -> None:
    import struct

    for calls in CALLS.values():
        lines = list(struct.iter_unpack("<HBBI", filter_program(calls)))

        def verdict(number: int, on: int, flags: int = 0, lines: list[tuple[int, ...]] = lines) -> int:
            at, value = 0, 0
            while True:
                code, yes, no, constant = lines[at]
                if code == 0x06:
                    return constant
                at += 1
                if code == 0x20:
                    value = {0: number, 4: on, 16: flags}[constant]
                    continue
                holds = {0x15: value == constant, 0x35: value >= constant, 0x45: bool(value & constant)}[code]
                at += yes if holds else no

        allowed, refused, absent = 0x7FFF0000, 0x00050000 | 1, 0x00050000 | 38
        found = {number: verdict(number, calls.machine) for number in range(600)}
        assert {number for number, each in found.items() if each == refused} == {
            *calls.refused.values(),
            calls.clone,
        }
        assert [number for number, each in found.items() if each == absent] == [calls.clone3]
        assert verdict(calls.clone, calls.machine, 0x10000 | 0x100) == allowed
        assert verdict(1, calls.machine ^ 1) == verdict(0x40000001, calls.machine) == refused
