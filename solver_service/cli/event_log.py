"""`fev-solver store log` and `fev-solver replay`: the event log of a run, and its frames computed again."""

from __future__ import annotations

import sys
from pathlib import Path

from solver_service.errors import StoreError
from solver_service.runs.event_log import is_same, parse_event_log, read_event_log, replay
from solver_service.store import DataFolder, RunDatabase, default_data_dir


def write_log(run: str, out: Path | None, data_dir: Path | None) -> None:
    """Write the log of a stored run to a file, or to standard output.

    Raises:
        StoreError: there is no such run, or the file cannot be written.
    """
    root = data_dir or default_data_dir()
    if not (root / "runs.sqlite").is_file():
        raise StoreError(f"The data folder '{root}' holds no runs.")
    database = RunDatabase(DataFolder(root).database)
    try:
        text = read_event_log(database, run).lines()
    finally:
        database.close()
    if out is None:
        sys.stdout.write(text.decode())
        return
    try:
        out.write_bytes(text)
    except OSError as error:
        raise StoreError(f"event log {out} cannot be written: {error.strerror or error}") from error


def replay_log(path: Path, case: str | None, threads: int | None) -> bool:
    """Compute the frames of a log again and compare their bytes.

    Returns:
        Whether all are the same.

    Raises:
        ServiceError: the log or the case cannot be read, or do not belong together.
    """
    try:
        log = parse_event_log(path.read_bytes())
    except OSError as error:
        raise StoreError(f"event log {path} cannot be read: {error.strerror or error}") from error
    different = [frame.index for frame, packed in replay(log, case, threads) if not is_same(frame, packed)]
    same = len(log.frames) - len(different)
    first = f"; the first that differs is {different[0]}" if different else ""
    print(f"{same} of {len(log.frames)} frames of run {log.run.run} have the very bytes of the log{first}")
    return not different
