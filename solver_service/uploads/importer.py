"""Starts the import process of one upload, hears it, and ends it when its time is over."""

from __future__ import annotations

import asyncio
import logging
import os
import signal
import sys
from collections.abc import Callable
from pathlib import Path

import msgspec

from solver_service.errors import CaseError
from solver_service.uploads.confinement import confined_environment
from solver_service.uploads.import_messages import (
    MAX_LINE_BYTES,
    MAX_LINES,
    Accepted,
    ImportLimits,
    Refused,
    Stage,
    unpack_line,
)

LOG = logging.getLogger(__name__)

MODULE = "solver_service.uploads.import_process"
LAST_WORDS_BYTES = 4096


async def import_case(folder: Path, limits: ImportLimits, on_stage: Callable[[Stage], None]) -> Accepted:
    """Let a process of its own import the archive of an upload.

    Args:
        folder: the folder of the upload, with the archive.
        limits: what the process may take.
        on_stage: called whenever it tells how far it is.

    Returns:
        What it found; the case is ready in the folder.

    Raises:
        CaseError: the case is refused, or the process was ended or died.
    """
    temporary = folder / "temporary"
    temporary.mkdir()
    process = await asyncio.create_subprocess_exec(
        *(sys.executable, "-P", "-m", MODULE, str(folder), str(os.getpid())),
        msgspec.json.encode(limits).decode(),
        stdin=asyncio.subprocess.DEVNULL,
        stdout=asyncio.subprocess.PIPE,
        stderr=asyncio.subprocess.PIPE,
        env=confined_environment(os.environ, str(temporary)),
        limit=MAX_LINE_BYTES,
        start_new_session=True,
    )
    assert process.stdout is not None
    assert process.stderr is not None
    words = asyncio.create_task(_last_words(process.stderr))
    try:
        async with asyncio.timeout(limits.time_s):
            verdict = await _hear(process.stdout, on_stage)
            if verdict is None:
                status = await process.wait()
                LOG.error("import process: %s: %s", _end(status), (await words).decode(errors="replace"))
                raise CaseError(
                    f"The case was not imported: {_end(status)}, at its limits"
                    f" ({limits.memory_bytes >> 20} MiB, {limits.time_s:g} s) or at a file that breaks"
                    " its reader."
                )
    except TimeoutError:
        raise CaseError(f"The case takes more than {limits.time_s:g} s to be imported.") from None
    except (ValueError, msgspec.MsgspecError) as error:
        LOG.error("import process: not a message: %s", error)
        raise CaseError("The case was not imported: its import process said what no import says.") from error
    finally:
        if process.returncode is None:
            process.kill()
        await process.stdout.read()  # what it said after that; it has no children that could go on
        await process.wait()
        await words
    if isinstance(verdict, Refused):
        raise CaseError(verdict.sentence)
    return verdict


async def _hear(lines: asyncio.StreamReader, on_stage: Callable[[Stage], None]) -> Accepted | Refused | None:
    """What the process decides; None where it ends without a word."""
    for _ in range(MAX_LINES):
        line = await lines.readline()
        if not line:
            return None
        message = unpack_line(line)
        if not isinstance(message, Stage):
            return message
        on_stage(message)
    raise ValueError(f"more than {MAX_LINES} lines")


async def _last_words(stream: asyncio.StreamReader) -> bytes:
    """The end of what is written to a stream."""
    kept = b""
    while part := await stream.read(LAST_WORDS_BYTES):
        kept = (kept + part)[-LAST_WORDS_BYTES:]
    return kept


def _end(status: int) -> str:
    if status < 0:
        return f"its process was ended by {signal.Signals(-status).name}"
    return f"its process ended with status {status}"
