"""A folder of results that appears complete or not at all.

Files are written into a new folder beside the wanted one and moved into place at the end; whatever goes wrong
before takes that folder away again.
"""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from solver_service.errors import RunError


@contextmanager
def output_folder(target: Path) -> Iterator[Path]:
    """A scratch folder whose content becomes that of the target when the block ends well.

    Files of the same name in the target are replaced, others stay.

    Args:
        target: the folder wanted; made where it does not exist.

    Raises:
        RunError: the place cannot be written, or the disk is full.
    """
    target = target.absolute()
    try:
        if target.exists() and not target.is_dir():
            raise RunError(f"The output folder '{target}' is a file; a folder is allowed.")
        target.parent.mkdir(parents=True, exist_ok=True)
        scratch = Path(tempfile.mkdtemp(prefix=f".{target.name}-", dir=target.parent))
    except OSError as error:
        raise RunError(f"The output folder '{target}' cannot be made: {error.strerror}.") from error
    try:
        yield scratch
        _move(scratch, target)
    except OSError as error:
        what = error.strerror or str(error)
        raise RunError(f"The results cannot be written to '{target}': {what}; nothing was kept.") from error
    finally:
        shutil.rmtree(scratch, ignore_errors=True)


def _move(scratch: Path, target: Path) -> None:
    if not target.exists():
        scratch.chmod(0o755)
        os.replace(scratch, target)
        return
    for entry in sorted(scratch.iterdir()):
        place = target / entry.name
        if place.is_dir() and not place.is_symlink():
            shutil.rmtree(place)
        os.replace(entry, place)
