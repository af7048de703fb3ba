"""Base beds on disk: lossless float32, zstd, one file per fingerprint, the very bytes that go on the wire."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import zstandard
from numpy.typing import NDArray

from solver_service.errors import StoreError
from solver_service.store.data_folder import DataFolder, fsync_folder


def save_bed(folder: DataFolder, fingerprint: str, z_b: NDArray[np.float32]) -> Path:
    """Write the bed [m] unless it is there already; complete or absent, never half.

    Args:
        folder: the data folder.
        fingerprint: hash of the bed, its name.
        z_b: bed elevation above the datum offset [m], [nrows, ncols], row 0 south.

    Returns:
        The file.
    """
    path = folder.terrain(fingerprint)
    if path.exists():
        return path
    temporary = path.with_name(f"{fingerprint}.{os.getpid()}.writing")
    packed = zstandard.ZstdCompressor(level=3).compress(np.ascontiguousarray(z_b, np.float32).tobytes())
    try:
        with temporary.open("wb") as file:
            file.write(packed)
            file.flush()
            os.fsync(file.fileno())
        temporary.replace(path)
        fsync_folder(path.parent)
    except OSError as error:
        temporary.unlink(missing_ok=True)
        raise StoreError(f"terrain {path} cannot be written: {error.strerror or error}") from error
    return path


def load_bed(folder: DataFolder, fingerprint: str) -> bytes:
    """The compressed bed as stored.

    Raises:
        StoreError: there is none.
    """
    path = folder.terrain(fingerprint)
    try:
        return path.read_bytes()
    except OSError as error:
        raise StoreError(f"terrain {path} cannot be read: {error.strerror or error}") from error
