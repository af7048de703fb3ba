"""Telling a full disk from a broken one, and trying whether there is room again."""

from __future__ import annotations

import errno
import os
import shutil
import sqlite3

from solver_service.errors import StoreError, StoreFull
from solver_service.store.data_folder import DataFolder

_FULL = frozenset({errno.ENOSPC, errno.EFBIG, getattr(errno, "EDQUOT", errno.ENOSPC)})
# a quota and a file limit reach SQLite as failed writes
_FULL_SQLITE = frozenset(
    {
        sqlite3.SQLITE_FULL,
        sqlite3.SQLITE_IOERR_WRITE,
        sqlite3.SQLITE_IOERR_FSYNC,
        sqlite3.SQLITE_IOERR_TRUNCATE,
        sqlite3.SQLITE_IOERR_SHMSIZE,
    }
)
PROBE = "room.writing"


def store_failure(error: OSError | sqlite3.Error, sentence: str) -> StoreError:
    """What a failed write means.

    Args:
        error: what the system or SQLite raised.
        sentence: what could not be done, where; the reason is added.

    Returns:
        A `StoreFull` where room is what lacks, else a `StoreError`.
    """
    if isinstance(error, sqlite3.Error):
        full = getattr(error, "sqlite_errorcode", None) in _FULL_SQLITE
        return (StoreFull if full else StoreError)(f"{sentence}: {error}")
    kind = StoreFull if error.errno in _FULL else StoreError
    return kind(f"{sentence}: {error.strerror or error}")


def free_bytes(folder: DataFolder) -> int:
    """Room on the disk of the data folder [bytes]."""
    return shutil.disk_usage(folder.root).free


def has_room(folder: DataFolder, size: int) -> bool:
    """Whether so much can be written, tried by writing it: quotas do not show in the free room of a disk.

    Args:
        folder: the data folder.
        size: bytes to try.
    """
    path = folder.root / PROBE
    block = bytes(1 << 20)
    try:
        descriptor = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600)
        try:
            while size > 0:
                size -= os.write(descriptor, block[: min(size, len(block))])
            os.fsync(descriptor)
        finally:
            os.close(descriptor)
            path.unlink()
    except OSError:
        return False
    return True
