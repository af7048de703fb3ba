"""What the service keeps on disk. A frame or checkpoint exists only when its row does."""

from solver_service.store.checkpoint_store import CheckpointStore, StoredState
from solver_service.store.data_folder import DataFolder, default_data_dir
from solver_service.store.frame_files import FrameReader, FrameWriter
from solver_service.store.mend import mend_run, remove_run_files
from solver_service.store.records import (
    CheckpointRecord,
    EditEvent,
    EditEventKind,
    FrameRecord,
    RunEvent,
    RunRecord,
)
from solver_service.store.run_database import RunDatabase
from solver_service.store.terrain_files import load_bed, save_bed

__all__ = [
    "CheckpointRecord",
    "CheckpointStore",
    "DataFolder",
    "EditEvent",
    "EditEventKind",
    "FrameReader",
    "FrameRecord",
    "FrameWriter",
    "RunDatabase",
    "RunEvent",
    "RunRecord",
    "StoredState",
    "default_data_dir",
    "load_bed",
    "mend_run",
    "remove_run_files",
    "save_bed",
]
