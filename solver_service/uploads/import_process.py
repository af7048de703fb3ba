"""The process that imports one case: it confines itself, unpacks, checks, and says what it found.

    python -m solver_service.uploads.import_process FOLDER PARENT LIMITS

FOLDER holds `archive.zip`; the case is left in FOLDER/shelf/case. PARENT is the process to end with, LIMITS
an `ImportLimits` as JSON. What it says goes to standard output, and whatever else writes there goes to
standard error.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import msgspec

from solver_service.errors import CaseError, ServiceError
from solver_service.uploads.confinement import confine
from solver_service.uploads.import_messages import (
    MAX_SENTENCE,
    Accepted,
    ImportLimits,
    ImportMessage,
    Refused,
    Stage,
    pack_line,
)

ARCHIVE = "archive.zip"
SHELF = "shelf"
CASE = "case"
STAGE_INTERVAL_S = 0.5
MAX_WARNINGS = 50


def main(folder: Path, parent: int, limits: ImportLimits, say: Callable[[ImportMessage], None]) -> None:
    """Import the archive of a folder.

    Args:
        folder: the folder of the upload.
        parent: id of the process to end with.
        limits: what may be taken.
        say: tells whoever asked for the import.
    """
    try:
        confine(limits, parent)
        say(import_archive(folder, limits, say))
    except ServiceError as error:
        say(Refused(_sentence(str(error), folder)))
    except MemoryError:
        say(Refused(f"The case needs more than {limits.memory_bytes >> 20} MiB of memory to be read."))


def import_archive(folder: Path, limits: ImportLimits, say: Callable[[ImportMessage], None]) -> Accepted:
    """Unpack the archive of a folder, look at every file, read the case and try its solver.

    Raises:
        ServiceError: the case cannot be run.
    """
    # only now, confined, is anything loaded that reads files
    from solver_service.offline import check_case
    from solver_service.scenario import load_case, summary_of
    from solver_service.scenario.case_archive import ArchiveLimits, unpack
    from solver_service.scenario.case_folder import inner_folder
    from solver_service.uploads.file_kinds import check_files

    unpacked, shelf = folder / "unpacked", folder / SHELF
    unpacked.mkdir()
    shelf.mkdir()
    last = 0.0

    def told(done: int, total: int) -> None:
        nonlocal last
        if time.monotonic() - last > STAGE_INTERVAL_S:
            last = time.monotonic()
            say(Stage("unpacking", done / max(total, 1)))

    unpack(folder / ARCHIVE, unpacked, ArchiveLimits(unpacked_bytes=limits.unpacked_bytes), told)
    root = inner_folder(unpacked, "the archive")
    check_files(root)
    root.rename(shelf / CASE)
    say(Stage("reading"))
    source = shelf / CASE
    case = load_case(source)
    if case.grid.cell_count > limits.cells:
        raise CaseError(
            f"case.toml: the grid has {case.grid.cell_count} cells; up to {limits.cells} are allowed, and a"
            " larger [terrain] cell_size makes fewer."
        )
    say(Stage("trying", 0.5))
    case = replace(case, params=replace(case.params, threads=1))
    report = check_case(case, "cpu", limits.probe_s)
    warnings = tuple(_sentence(text, folder) for text in report.warnings[:MAX_WARNINGS])
    return Accepted(summary_of(case), warnings)


def _sentence(text: str, folder: Path) -> str:
    """A sentence without the places of this machine."""
    case = str(folder / SHELF / CASE)
    return text.replace(f"{case}/", "").replace(case, "the case").replace(str(folder), "")[:MAX_SENTENCE]


if __name__ == "__main__":
    channel = os.fdopen(os.dup(1), "wb", buffering=0)
    os.dup2(2, 1)  # whatever a library prints is no message
    main(
        Path(sys.argv[1]),
        int(sys.argv[2]),
        msgspec.json.decode(sys.argv[3], type=ImportLimits),
        lambda message: (channel.write(pack_line(message)), None)[1],
    )
