"""Full-precision states as Zarr v3: temporary folder, fsync, rename, row; checked by checksum when read.

At least `KEEP` checkpoints of a run stay, so that a torn newest one always has a predecessor. Scalars are
kept as hexadecimal floats, because a restart must be exact to the bit.
"""

from __future__ import annotations

import os
import shutil
import uuid
import zlib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import zarr
from numpy.typing import NDArray
from zarr.codecs import ZstdCodec

from solver_service.errors import StoreError
from solver_service.store.data_folder import DataFolder, fsync_file, fsync_folder
from solver_service.store.records import CheckpointRecord
from solver_service.store.room import store_failure
from solver_service.store.run_database import RunDatabase

KEEP = 3
CHUNK_CELLS = 4 * 1024 * 1024


@dataclass(frozen=True)
class StoredState:
    """A state as the store sees it: named arrays and numbers.

    Attributes:
        time: simulated time [s].
        step_count: solver steps done.
        arrays: name to array.
        scalars: name to number.
    """

    time: float
    step_count: int
    arrays: Mapping[str, NDArray[Any]]
    scalars: Mapping[str, float | int]


class CheckpointStore:
    """Checkpoints of all runs below one data folder; one object a thread."""

    def __init__(self, folder: DataFolder, database: RunDatabase, keep: int = KEEP) -> None:
        """Use a data folder.

        Args:
            folder: the data folder.
            database: the connection of the calling thread.
            keep: how many of the newest checkpoints of a run stay, beside its first one.
        """
        self._folder = folder
        self._database = database
        self._keep = keep

    def write(self, run: str, state: StoredState) -> CheckpointRecord:
        """Store a state; when this returns it survives a power cut. Older ones beyond the budget go.

        Raises:
            StoreError: the disk is full or broken; nothing of the state is visible.
        """
        name = f"step{state.step_count}-{uuid.uuid4().hex[:8]}"
        parent = self._folder.checkpoints(run)
        temporary = parent / f"{name}.writing"
        try:
            parent.mkdir(parents=True, exist_ok=True)
            _write_group(temporary, state)
            size = _fsync_tree(temporary)
            temporary.rename(parent / name)
            fsync_folder(parent)
            record = CheckpointRecord(run, state.time, state.step_count, name, _checksum(state), size)
            self._database.insert_checkpoint(record)
        except (OSError, StoreError) as error:
            shutil.rmtree(temporary, ignore_errors=True)
            shutil.rmtree(parent / name, ignore_errors=True)
            sentence = f"checkpoint of run {run} at {state.time} s cannot be stored in {parent}"
            if isinstance(error, OSError):
                raise store_failure(error, sentence) from error
            raise type(error)(f"{sentence}: {error}") from error
        self._retire(run)
        return record

    def read(self, record: CheckpointRecord) -> StoredState:
        """Load one checkpoint.

        Raises:
            StoreError: it is missing or torn.
        """
        path = self._folder.checkpoints(record.run) / record.name
        try:
            group = zarr.open_group(path, mode="r")
            arrays = {name: np.asarray(array[...]) for name, array in group.arrays()}
            written: Any = group.attrs["scalars"]
            scalars = {name: _number(text) for name, text in written.items()}
        except Exception as error:  # zarr and its codecs raise many kinds for torn files
            raise StoreError(f"checkpoint {path} cannot be read: {error}") from error
        state = StoredState(record.time, record.step_count, arrays, scalars)
        if _checksum(state) != record.crc32:
            raise StoreError(f"checkpoint {path} is damaged")
        return state

    def latest(self, run: str, time: float) -> tuple[StoredState | None, list[str]]:
        """The newest whole checkpoint of a run at or before a time [s].

        Returns:
            The state, or None where there is none, and a sentence for every damaged one that was passed over.
        """
        passed_over: list[str] = []
        for record in reversed(self._database.checkpoints(run)):
            if record.time > time:
                continue
            try:
                return self.read(record), passed_over
            except StoreError as error:
                passed_over.append(str(error))
        return None, passed_over

    def _retire(self, run: str) -> None:
        """Drop the middle: the first (the branch point) and the newest stay."""
        for record in self._database.checkpoints(run)[1 : -self._keep]:
            remove_checkpoint(self._database, self._folder, record)


def remove_checkpoint(database: RunDatabase, folder: DataFolder, record: CheckpointRecord) -> None:
    """Forget a checkpoint and free its room."""
    database.delete_checkpoint(record)
    shutil.rmtree(folder.checkpoints(record.run) / record.name, ignore_errors=True)


def remove_orphans(folder: DataFolder, database: RunDatabase, run: str) -> int:
    """Delete checkpoint folders of a run that have no row (a crash between rename and commit)."""
    known = {record.name for record in database.checkpoints(run)}
    orphans = [path for path in folder.checkpoints(run).glob("*") if path.name not in known]
    for path in orphans:
        shutil.rmtree(path, ignore_errors=True)
    return len(orphans)


def _write_group(path: Path, state: StoredState) -> None:
    group = zarr.create_group(path, zarr_format=3)
    for name, array in sorted(state.arrays.items()):
        rows = max(1, CHUNK_CELLS // max(1, int(np.prod(array.shape[1:])))) if array.ndim else 1
        chunks = (min(array.shape[0], rows) or 1, *(n or 1 for n in array.shape[1:])) if array.ndim else ()
        stored = group.create_array(
            name,
            shape=array.shape,
            dtype=array.dtype,
            chunks=chunks,
            compressors=ZstdCodec(level=1),
            fill_value=None,
        )
        stored[...] = array
    group.attrs["scalars"] = {name: _text(value) for name, value in sorted(state.scalars.items())}


def _fsync_tree(path: Path) -> int:
    size = 0
    for folder, _, files in os.walk(path):
        for name in files:
            fsync_file(Path(folder) / name)
            size += (Path(folder) / name).stat().st_size
        fsync_folder(Path(folder))
    return size


def _text(value: float | int) -> str:
    return str(int(value)) if isinstance(value, int | np.integer) else float(value).hex()


def _number(text: str) -> float | int:
    return float.fromhex(text) if "x" in text or "n" in text else int(text)


def _checksum(state: StoredState) -> int:
    crc = 0
    for name, array in sorted(state.arrays.items()):
        head = f"{name} {array.dtype.str} {array.shape}"
        crc = zlib.crc32(
            np.ascontiguousarray(array).reshape(-1).view(np.uint8).data, zlib.crc32(head.encode(), crc)
        )
    for name, value in sorted(state.scalars.items()):
        crc = zlib.crc32(f"{name}={_text(value)}".encode(), crc)
    return crc
