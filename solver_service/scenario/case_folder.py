"""Where the files of a case lie: a folder, or a .fevcase archive unpacked with care.

A case names its files by relative paths that never leave its folder. An archive is unpacked into a temporary
folder, with limits, and nothing in it may point outside.
"""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from solver_service.errors import CaseError
from solver_service.scenario.case_archive import unpack

CASE_FILE = "case.toml"
ARCHIVE_SUFFIX = ".fevcase"
MAX_CASE_FILE_BYTES = 4 << 20


@dataclass(frozen=True)
class CaseFolder:
    """A case file and the folder that its paths are relative to.

    Attributes:
        case_file: the case file.
        root: the folder of the files it names.
        temporary: whether the folder goes away once the case is loaded.
    """

    case_file: Path
    root: Path
    temporary: bool = False

    def text(self) -> str:
        """The case file.

        Raises:
            CaseError: it cannot be read as text.
        """
        try:
            if self.case_file.stat().st_size > MAX_CASE_FILE_BYTES:
                raise CaseError(f"{self.case_file}: is larger than {MAX_CASE_FILE_BYTES} bytes.")
            return self.case_file.read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            reason = getattr(error, "strerror", None) or error
            raise CaseError(f"{self.case_file}: cannot be read: {reason}.") from error

    def find(self, name: str, said_by: str) -> Path:
        """A file that the case names.

        Args:
            name: relative path with forward slashes.
            said_by: file, table and key, to begin the error with.

        Raises:
            CaseError: the path is absolute, leaves the folder, or leads to no file.
        """
        parts = PurePosixPath(name).parts
        if not name or "\\" in name or "\0" in name or ":" in name or name.startswith("/") or ".." in parts:
            raise CaseError(
                f"{said_by} is '{name[:200]}'; a relative path within the folder of the case is allowed."
            )
        path = self.root.joinpath(*parts)
        try:
            inside = path.resolve().is_relative_to(self.root.resolve())
        except OSError as error:
            raise CaseError(f"{said_by} is '{name[:200]}', which cannot be followed: {error}.") from error
        if not inside:
            raise CaseError(
                f"{said_by} is '{name}', a link out of the folder of the case; a file within it is allowed."
            )
        if not path.is_file():
            raise CaseError(f"{said_by} is '{name}', which does not exist in {self.root}.")
        return path


@contextmanager
def open_case(path: Path) -> Iterator[CaseFolder]:
    """The folder of a case, unpacked for the time of the block where it is an archive.

    Args:
        path: a folder with a case.toml, a case file, or a .fevcase archive.

    Raises:
        CaseError: there is no case.
    """
    if path.is_dir():
        path = path / CASE_FILE
    if not path.is_file():
        raise CaseError(f"{path}: no such case file.")
    if path.suffix.lower() == ".toml":
        yield CaseFolder(path, path.parent)
        return
    if path.suffix.lower() != ARCHIVE_SUFFIX:
        raise CaseError(
            f"{path}: is no case; a folder with a {CASE_FILE}, a .toml or a {ARCHIVE_SUFFIX} is allowed."
        )
    unpacked = Path(tempfile.mkdtemp(prefix="fevcase-"))
    try:
        unpack(path, unpacked)
        inner = inner_folder(unpacked, path.name)
        yield CaseFolder(inner / CASE_FILE, inner, temporary=True)
    finally:
        shutil.rmtree(unpacked, ignore_errors=True)


def inner_folder(unpacked: Path, archive: str) -> Path:
    """The folder of the case file in what was unpacked: the folder itself or the only one in it.

    Args:
        unpacked: where an archive was unpacked.
        archive: its name, for the error.

    Raises:
        CaseError: there is no case file.
    """
    below = list(unpacked.iterdir())
    inner = unpacked
    if not (inner / CASE_FILE).is_file() and len(below) == 1 and below[0].is_dir():
        inner = below[0]
    if not (inner / CASE_FILE).is_file():
        raise CaseError(f"{archive}: holds no {CASE_FILE}.")
    return inner
