"""A copy of the store, made while the service runs.

The rows are copied first, by SQLite's own online backup, as they are at one moment; then the files that they
name. Segment files only grow, so what a row names stays where it is; where a run was deleted, compacted or
relieved of a checkpoint meanwhile, the rows are copied once more. Uploaded cases are copied, too. The copy is
checked before it counts.
"""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import get_args

from protocol import Layer
from solver_service.errors import StoreError
from solver_service.store.data_folder import DataFolder, fsync_file, fsync_folder
from solver_service.store.integrity import find_faults
from solver_service.store.room import store_failure
from solver_service.store.run_database import RunDatabase

ATTEMPTS = 5


def back_up(folder: DataFolder, destination: Path) -> int:
    """Copy the store of a folder, which a service may be using, into a new folder.

    Args:
        folder: the data folder.
        destination: the folder to make; it may exist where it is empty.

    Returns:
        The size of the copy [bytes].

    Raises:
        StoreError: the destination is in use, there is no room, or the store is damaged.
    """
    if destination.exists() and any(destination.iterdir()):
        raise StoreError(f"backup folder {destination} is not empty; a new or an empty folder is allowed")
    unfinished = destination.with_name(f"{destination.name}.writing")
    shutil.rmtree(unfinished, ignore_errors=True)
    try:
        size = _copy(folder, unfinished)
        if destination.exists():
            destination.rmdir()
        unfinished.rename(destination)
        fsync_folder(destination.parent)
    except OSError as error:
        raise store_failure(error, f"store {folder.root} cannot be copied to {destination}") from error
    finally:
        shutil.rmtree(unfinished, ignore_errors=True)
    return size


def _copy(folder: DataFolder, destination: Path) -> int:
    copy = DataFolder(destination)
    source = RunDatabase(folder.database)
    missing, faults = "", [""]
    try:
        for _ in range(ATTEMPTS):
            source.copy_to(copy.database)
            rows = RunDatabase(copy.database)
            try:
                missing = _copy_files(folder, copy, rows)
                faults = [fault.sentence for fault in find_faults(copy, rows)] if not missing else []
            finally:
                rows.close()
            if not missing:
                break
        else:
            raise StoreError(f"store {folder.root} changes too fast to be copied: {missing} is gone again")
    finally:
        source.close()
    _copy_cases(folder, copy)
    if faults:
        raise StoreError(f"the copy of store {folder.root} is not whole: {faults[0]}")
    for path in _files(destination):
        fsync_file(path)
    return sum(path.stat().st_size for path in _files(destination))


def _copy_files(folder: DataFolder, copy: DataFolder, rows: RunDatabase) -> str:
    """Copy what the rows name; gives the first thing that is gone, or nothing."""
    wanted: set[Path] = set()
    for run in rows.runs():
        ends = rows.segment_ends(run.run)
        for segment, end in ends.items():
            wanted.add(copy.frames(run.run) / segment)
            if not _copy_head(folder.frames(run.run) / segment, copy.frames(run.run) / segment, end):
                return f"{segment} of run {run.run}"
        for record in rows.checkpoints(run.run):
            target = copy.checkpoints(run.run) / record.name
            wanted.add(target)
            try:
                shutil.copytree(folder.checkpoints(run.run) / record.name, target, dirs_exist_ok=True)
            except (FileNotFoundError, shutil.Error):
                return f"checkpoint {record.name} of run {run.run}"
        terrain = copy.terrain(run.case_fingerprint)
        if not terrain.exists():
            shutil.copyfile(folder.terrain(run.case_fingerprint), terrain)
        for picture in folder.root.glob(f"terrain/{run.case_fingerprint}.*"):
            if picture.suffix.removeprefix(".") in get_args(Layer):
                shutil.copyfile(picture, copy.root / "terrain" / picture.name)
    for path in (*copy.root.glob("frames/*/*"), *copy.root.glob("checkpoints/*/*")):
        if path not in wanted:  # of an attempt before
            shutil.rmtree(path) if path.is_dir() else path.unlink()
    known = {run.run for run in rows.runs()}
    for path in (*copy.root.glob("frames/*"), *copy.root.glob("checkpoints/*")):
        if path.name not in known:
            shutil.rmtree(path)
    return ""


def _copy_cases(folder: DataFolder, copy: DataFolder) -> None:
    """Copy the uploaded cases; one that is removed meanwhile has no run, and is left out."""
    for path in sorted((folder.root / "cases").iterdir()):
        target = copy.case(path.name)
        try:
            shutil.copytree(path, target)
        except (FileNotFoundError, shutil.Error):
            shutil.rmtree(target, ignore_errors=True)
            if path.exists():
                raise


def _copy_head(source: Path, target: Path, size: int) -> bool:
    """Copy the committed part of a segment; False when the file is gone."""
    target.parent.mkdir(parents=True, exist_ok=True)
    try:
        with source.open("rb") as reading, target.open("wb") as writing:
            shutil.copyfileobj(reading, writing, 1 << 20)
            writing.truncate(size)
    except FileNotFoundError:
        return False
    return True


def _files(root: Path) -> Iterator[Path]:
    for folder, _, names in os.walk(root):
        for name in names:
            yield Path(folder) / name
