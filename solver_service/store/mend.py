"""Bring the files of a run to what its rows say, after a crash and after a deletion."""

from __future__ import annotations

import shutil

from solver_service.store.checkpoint_store import remove_orphans
from solver_service.store.data_folder import DataFolder
from solver_service.store.frame_files import recover_segments
from solver_service.store.run_database import RunDatabase


def mend_run(folder: DataFolder, database: RunDatabase, run: str) -> None:
    """Cut torn tails and remove what has no row; nobody may write for the run meanwhile."""
    recover_segments(folder, database, run)
    remove_orphans(folder, database, run)


def remove_run_files(folder: DataFolder, run: str) -> None:
    """Free the room of a run that has no rows any more; what a crash leaves of it goes at the next start."""
    for path in (folder.frames(run), folder.checkpoints(run)):
        shutil.rmtree(path, ignore_errors=True)
