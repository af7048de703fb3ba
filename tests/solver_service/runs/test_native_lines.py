import logging
import multiprocessing
import os
import signal
import subprocess
import sys

import pytest

from solver_service.runs.native_lines import tell_lines

CRASH = """
import ctypes, os, sys
from multiprocessing.connection import Connection
from solver_service.runs.native_lines import give_stderr_to
kept = give_stderr_to(Connection(int(sys.argv[1]), readable=False))
print("a line of our own", file=kept)
os.write(2, b"from a library\\n\\n")
print("from Python", file=sys.stderr)
os.write(2, b"\\xff without an end")
ctypes.string_at(0)
"""


@pytest.mark.skipif(os.name != "posix", reason="pipes have descriptors on POSIX only")
def test_every_word_of_a_process_that_crashes_becomes_a_line_and_its_own_stream_stays(
    caplog: pytest.LogCaptureFixture,
) -> None:
    reader, writer = multiprocessing.Pipe(duplex=False)
    process = subprocess.run(
        [sys.executable, "-c", CRASH, str(writer.fileno())],
        pass_fds=[writer.fileno()],
        stderr=subprocess.PIPE,
        text=True,
        timeout=60,
        check=False,
    )
    writer.close()
    with caplog.at_level(logging.WARNING):
        tell_lines(reader, lambda: "r1")

    assert process.returncode == -signal.SIGSEGV
    assert process.stderr == "a line of our own\n"
    told = [record.getMessage() for record in caplog.records]
    assert told[:2] == ["from a library", "from Python"]
    assert "\ufffd without an end" in told[2]
    assert any("Segmentation fault" in line for line in told)
    assert {vars(record)["run"] for record in caplog.records} == {"r1"}
