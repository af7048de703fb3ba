"""`fev-solver store`: look at the data folder of a service, mend it, copy it."""

from __future__ import annotations

from pathlib import Path

from solver_service.errors import StoreError
from solver_service.store import (
    DataFolder,
    Fault,
    RunDatabase,
    back_up,
    default_data_dir,
    find_faults,
    repair,
)


def check_store(data_dir: Path | None) -> bool:
    """Look at every row and file and tell what is wrong; while a service runs, at what it has committed.

    Returns:
        Whether all is well.

    Raises:
        StoreError: the folder holds no runs.
    """
    folder = _folder(data_dir)
    try:
        folder.lock()
        in_use = False
    except StoreError:
        in_use = True
    database = RunDatabase(folder.database)
    try:
        faults = list(find_faults(folder, database, with_litter=not in_use))
        runs = len(database.runs())
    finally:
        database.close()
        folder.unlock()
    _tell(faults)
    about = " (a service uses it: files without rows were not looked for)" if in_use else ""
    print(f"{runs} runs, {len(faults)} faults in {folder.root}{about}")
    return not faults


def repair_store(data_dir: Path | None) -> bool:
    """Mend what can be mended, while no service runs.

    Returns:
        Whether all is well afterwards.

    Raises:
        StoreError: a service uses the folder, or it holds no runs.
    """
    folder = _folder(data_dir)
    with folder:
        database = RunDatabase(folder.database)
        try:
            database.begin_epoch()
            faults = list(find_faults(folder, database))
            _tell(faults)
            for sentence in repair(folder, database, faults):
                print(f"mended: {sentence}")
            left = list(find_faults(folder, database))
        finally:
            database.close()
    for fault in left:
        print(f"not mended: {fault.sentence}")
    print(f"{len(faults)} faults found, {len(left)} left in {folder.root}")
    return not left


def backup_store(destination: Path, data_dir: Path | None) -> None:
    """Copy the store, also while a service runs.

    Raises:
        StoreError: the destination is not empty, there is no room, or the store is damaged.
    """
    folder = _folder(data_dir)
    size = back_up(folder, destination)
    print(f"{size / 1e6:.1f} MB of {folder.root} copied to {destination} and checked")


def _folder(data_dir: Path | None) -> DataFolder:
    root = data_dir or default_data_dir()
    if not (root / "runs.sqlite").is_file():
        raise StoreError(f"The data folder '{root}' holds no runs.")
    return DataFolder(root)


def _tell(faults: list[Fault]) -> None:
    for fault in faults:
        print(fault.sentence)
