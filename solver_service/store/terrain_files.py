"""Terrains on disk, the very bytes that go on the wire, named by the fingerprint of their bed.

A base bed is lossless float32 in zstd; the pictures that belong to it are a JPEG and a PNG.
"""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import zstandard
from numpy.typing import NDArray

from protocol import Layer
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
    packed = zstandard.ZstdCompressor(level=3).compress(np.ascontiguousarray(z_b, np.float32).tobytes())
    _write(path, packed)
    return path


def load_bed(folder: DataFolder, fingerprint: str) -> bytes:
    """The compressed bed as stored.

    Raises:
        StoreError: there is none.
    """
    return _read(folder.terrain(fingerprint))


def save_layer(folder: DataFolder, fingerprint: str, layer: Layer, picture: bytes) -> Path:
    """Write a picture of a terrain over the one before; complete or absent, never half.

    Args:
        folder: the data folder.
        fingerprint: name of the bed.
        layer: which picture.
        picture: the bytes of its file.

    Returns:
        The file.
    """
    path = folder.layer(fingerprint, layer)
    _write(path, picture)
    return path


def load_layer(folder: DataFolder, fingerprint: str, layer: Layer) -> bytes:
    """A picture of a terrain as stored.

    Raises:
        StoreError: there is none.
    """
    return _read(folder.layer(fingerprint, layer))


def _write(path: Path, data: bytes) -> None:
    temporary = path.with_name(f"{path.name}.{os.getpid()}.writing")
    try:
        with temporary.open("wb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        temporary.replace(path)
        fsync_folder(path.parent)
    except OSError as error:
        temporary.unlink(missing_ok=True)
        raise StoreError(f"terrain {path} cannot be written: {error.strerror or error}") from error


def _read(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError as error:
        raise StoreError(f"terrain {path} cannot be read: {error.strerror or error}") from error
