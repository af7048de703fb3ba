"""What libraries of a worker write to standard error by themselves, Warp and CUDA above all, as log lines.

The worker gives its standard error away to a pipe and keeps the stream of the service for its own lines. The
service reads the pipe, so that also the last words of a process that crashes are told.
"""

from __future__ import annotations

import faulthandler
import logging
import os
import sys
from collections.abc import Callable
from multiprocessing.connection import Connection
from typing import TextIO

LOG = logging.getLogger(__name__)

STDERR = 2


def give_stderr_to(pipe: Connection) -> TextIO:
    """Let everything that is written to standard error of this process go into a pipe.

    Where the system has no descriptors for pipes (Windows) all stays as it is.

    Returns:
        The stream that standard error was before.
    """
    if os.name != "posix":
        return sys.stderr
    before = os.fdopen(os.dup(STDERR), "w", buffering=1, encoding="utf-8", errors="backslashreplace")
    os.dup2(pipe.fileno(), STDERR)
    pipe.close()
    faulthandler.enable(STDERR)
    return before


def tell_lines(pipe: Connection, run: Callable[[], str | None]) -> None:
    """Log each line that comes out of a pipe, until it ends.

    Args:
        pipe: the reading end.
        run: gives the id of the run that the process computes.
    """
    if os.name == "posix":
        with open(pipe.fileno(), encoding="utf-8", errors="replace", closefd=False) as lines:
            for line in lines:
                if line.strip():
                    LOG.warning("%s", line.rstrip("\n"), extra={"run": run()})
    pipe.close()
