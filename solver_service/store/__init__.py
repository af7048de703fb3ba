"""What the service keeps on disk. A frame or checkpoint exists only when its row does."""

from solver_service.store.backup import back_up
from solver_service.store.case_shelf import CaseShelf, ShelvedCase
from solver_service.store.checkpoint_store import CheckpointStore, StoredState, remove_checkpoint
from solver_service.store.compaction import compact_run, is_scattered
from solver_service.store.data_folder import DataFolder, default_data_dir
from solver_service.store.frame_files import FrameReader, FrameWriter
from solver_service.store.integrity import Fault, find_faults, repair
from solver_service.store.mend import mend_run, remove_run_files
from solver_service.store.records import (
    ChannelRecord,
    CheckpointRecord,
    EditEvent,
    EditEventKind,
    ForcingEvent,
    FrameRecord,
    RunEvent,
    RunRecord,
    StoredBytes,
)
from solver_service.store.retention import Removal, StoredRun, plan_removals
from solver_service.store.room import free_bytes, has_room
from solver_service.store.run_database import RunDatabase
from solver_service.store.terrain_files import load_bed, load_layer, save_bed, save_layer

__all__ = [
    "CaseShelf",
    "ChannelRecord",
    "CheckpointRecord",
    "CheckpointStore",
    "DataFolder",
    "EditEvent",
    "EditEventKind",
    "Fault",
    "ForcingEvent",
    "FrameReader",
    "FrameRecord",
    "FrameWriter",
    "Removal",
    "RunDatabase",
    "RunEvent",
    "RunRecord",
    "ShelvedCase",
    "StoredBytes",
    "StoredRun",
    "StoredState",
    "back_up",
    "compact_run",
    "default_data_dir",
    "find_faults",
    "free_bytes",
    "has_room",
    "is_scattered",
    "load_bed",
    "load_layer",
    "mend_run",
    "plan_removals",
    "remove_checkpoint",
    "remove_run_files",
    "repair",
    "save_bed",
    "save_layer",
]
