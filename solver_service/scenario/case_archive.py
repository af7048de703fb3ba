"""Unpacking a .fevcase archive that may be hostile.

Everything that an archive says of itself is checked before a byte is unpacked: its directory, every name,
every size, and that no two entries share bytes. What is unpacked is counted again while it is written. Only
plain files that are stored or deflated are taken; archives within are files like others and are not opened.

The checks follow what zip bombs and parsers that disagree have used: entries that overlap, a directory that
is larger than it says, names that end at a NUL, links, paths out of the folder
(Fifield, A better zip bomb, 2019).
"""

from __future__ import annotations

import itertools
import stat
import struct
import zipfile
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import BinaryIO

from solver_service.errors import CaseError
from solver_service.terrain import BROKEN_ARCHIVE

MAX_ARCHIVE_FILES = 10_000
MAX_ARCHIVE_BYTES = 4 << 30
MAX_RATIO = 1000
"""Largest size of a file in units of its packed size."""
MAX_DIRECTORY_BYTES = 4 << 20
MAX_NAME = 200
MAX_FOLDERS = 8
CHUNK_BYTES = 1 << 20

_END, _END_BYTES, _MAX_COMMENT = b"PK\5\6", 22, 0xFFFF
_LOCATOR_64, _LOCATOR_64_BYTES = b"PK\6\7", 20
_LOCAL, _LOCAL_BYTES = b"PK\3\4", 30
_ENCRYPTED = 0x1


@dataclass(frozen=True)
class ArchiveLimits:
    """How large an archive may be.

    Attributes:
        files: most entries.
        unpacked_bytes: most bytes of all files together, unpacked.
    """

    files: int = MAX_ARCHIVE_FILES
    unpacked_bytes: int = MAX_ARCHIVE_BYTES


def unpack(
    path: Path,
    target: Path,
    limits: ArchiveLimits | None = None,
    on_progress: Callable[[int, int], None] | None = None,
) -> None:
    """Unpack an archive into a folder.

    Args:
        path: the archive.
        target: an empty folder.
        limits: how large it may be.
        on_progress: called with the bytes unpacked and those in all.

    Raises:
        CaseError: it is no archive, or one that is not allowed; what was unpacked until then stays in the
            folder.
    """
    try:
        with path.open("rb") as file:
            directory_at = _check_end(file, path.name)
            with zipfile.ZipFile(file) as archive:
                entries = archive.infolist()
                _check_entries(entries, path.name, limits or ArchiveLimits())
                _check_places(file, entries, path.name, directory_at)
                total, done = sum(entry.file_size for entry in entries), 0
                for entry in entries:
                    for size in _unpack_entry(archive, entry, path.name, target):
                        done += size
                        if on_progress is not None:
                            on_progress(done, total)
    except BROKEN_ARCHIVE as error:
        raise CaseError(f"{path.name}: cannot be unpacked: {error}.") from error


def _check_end(file: BinaryIO, name: str) -> int:
    """Where the directory begins; refuses one that is too large before anybody reads it."""
    size = file.seek(0, 2)
    tail_bytes = min(size, _END_BYTES + _MAX_COMMENT)
    file.seek(size - tail_bytes)
    tail = file.read(tail_bytes)
    at = tail.rfind(_END)
    if at < 0 or at + _END_BYTES > len(tail):
        raise CaseError(f"{name}: is no zip archive, or its end is missing.")
    _, disk, start_disk, here, count, directory_bytes, directory_at, comment = struct.unpack_from(
        "<4s4H2LH", tail, at
    )
    end_at = size - tail_bytes + at
    if tail[max(at - _LOCATOR_64_BYTES, 0) : at].startswith(_LOCATOR_64) or 0xFFFF in (here, count):
        raise CaseError(f"{name}: is a zip64 archive; one of less than 65535 files and 4 GiB is allowed.")
    if disk or start_disk or here != count or at + _END_BYTES + comment != len(tail):
        raise CaseError(f"{name}: is not one whole zip archive.")
    if directory_at + directory_bytes != end_at:
        raise CaseError(f"{name}: its directory does not stand before its end; a plain archive is allowed.")
    if directory_bytes > MAX_DIRECTORY_BYTES:
        raise CaseError(
            f"{name}: has a directory of {directory_bytes} bytes; up to {MAX_DIRECTORY_BYTES} are allowed."
        )
    return int(directory_at)


def _check_entries(entries: Sequence[zipfile.ZipInfo], name: str, limits: ArchiveLimits) -> None:
    """Refuse names, kinds and sizes that are not allowed."""
    if len(entries) > limits.files:
        raise CaseError(f"{name}: holds {len(entries)} files; up to {limits.files} are allowed.")
    total = sum(entry.file_size for entry in entries)
    if total > limits.unpacked_bytes:
        raise CaseError(f"{name}: unpacks to {total} bytes; up to {limits.unpacked_bytes} are allowed.")
    seen: set[str] = set()
    for entry in entries:
        shown = entry.orig_filename[:MAX_NAME]
        _check_name(entry, name)
        folded = entry.filename.rstrip("/").casefold()
        if folded in seen:
            raise CaseError(f"{name}: holds '{shown}' twice; each name once is allowed.")
        seen.add(folded)
        mode = entry.external_attr >> 16
        if stat.S_ISLNK(mode) or stat.S_IFMT(mode) not in (0, stat.S_IFREG, stat.S_IFDIR):
            raise CaseError(f"{name}: holds the link or device '{shown}'; plain files are allowed.")
        if entry.flag_bits & _ENCRYPTED:
            raise CaseError(f"{name}: '{shown}' is encrypted; files without a password are allowed.")
        if entry.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
            raise CaseError(
                f"{name}: '{shown}' is packed by method {entry.compress_type}; 0 (stored) and 8 (deflated)"
                " are allowed."
            )
        if entry.file_size > MAX_RATIO * max(entry.compress_size, 1):
            raise CaseError(
                f"{name}: '{shown}' unpacks to {entry.file_size} bytes, over {MAX_RATIO} times its packed"
                f" {entry.compress_size}."
            )


def _check_name(entry: zipfile.ZipInfo, archive: str) -> None:
    name = entry.orig_filename
    parts = PurePosixPath(name).parts
    if name.startswith("/") or "\\" in name or ":" in name or ".." in parts or not parts:
        raise CaseError(f"{archive}: holds '{name[:MAX_NAME]}', a path that leaves the archive.")
    plain = name.isprintable() and name == entry.filename and len(name) <= MAX_NAME
    if not plain or len(parts) > MAX_FOLDERS or any(part != part.rstrip(" .") for part in parts):
        raise CaseError(
            f"{archive}: holds {name[:MAX_NAME]!r}; names of up to {MAX_NAME} printable characters in up to"
            f" {MAX_FOLDERS - 1} folders, without a space or dot at the end, are allowed."
        )


def _check_places(file: BinaryIO, entries: Sequence[zipfile.ZipInfo], name: str, directory_at: int) -> None:
    """Refuse entries that share bytes with each other or with the directory."""
    ordered = sorted(entries, key=lambda entry: entry.header_offset)
    ends = [entry.header_offset for entry in ordered[1:]] + [directory_at]
    for entry, end in itertools.zip_longest(ordered, ends[: len(ordered)]):
        file.seek(entry.header_offset)
        header = file.read(_LOCAL_BYTES)
        if len(header) < _LOCAL_BYTES or not header.startswith(_LOCAL):
            raise CaseError(f"{name}: '{entry.filename}' is not where the directory says.")
        name_bytes, extra_bytes = struct.unpack_from("<2H", header, 26)
        if entry.header_offset + _LOCAL_BYTES + name_bytes + extra_bytes + entry.compress_size > end:
            raise CaseError(f"{name}: '{entry.filename}' overlaps what comes after it.")


def _unpack_entry(archive: zipfile.ZipFile, entry: zipfile.ZipInfo, name: str, target: Path) -> Iterator[int]:
    """Write one entry; gives the sizes of what was written as it is."""
    place = target.joinpath(*PurePosixPath(entry.filename).parts)
    if entry.is_dir():
        place.mkdir(parents=True, exist_ok=True)
        return
    place.parent.mkdir(parents=True, exist_ok=True)
    left = entry.file_size
    with archive.open(entry) as source, place.open("xb") as file:
        while chunk := source.read(CHUNK_BYTES):
            left -= len(chunk)
            if left < 0:
                raise CaseError(f"{name}: '{entry.filename}' is larger than it says.")
            file.write(chunk)
            yield len(chunk)
