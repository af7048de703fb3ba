"""Is everything that has a row whole, and has everything that is there a row; and mending what is not.

Repair loses nothing that can be had: a damaged checkpoint is forgotten, for an earlier one gives the same
bits; from a damaged frame on the frames of a run are forgotten, and resuming it computes them again. A
damaged channel is forgotten alone.
"""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from dataclasses import dataclass

import zstandard

from solver_service.errors import StoreError
from solver_service.store.checkpoint_store import CheckpointStore
from solver_service.store.data_folder import DataFolder
from solver_service.store.frame_files import FrameReader, segment_files
from solver_service.store.mend import mend_run
from solver_service.store.records import ChannelRecord, CheckpointRecord, RunRecord
from solver_service.store.run_database import RunDatabase

PAUSED, STOPPED = "paused", "stopped"
LOST = "frames were damaged on the disk; resume computes them again"


@dataclass(frozen=True)
class Fault:
    """Something that is not as it should be.

    Attributes:
        sentence: what, for people.
        run: the run it is about, if any.
        from_index: frames from here on are not usable.
        checkpoint: the checkpoint that is not usable.
        channel: the channel of a frame that is not usable.
        is_litter: whether it is only room that nobody uses.
    """

    sentence: str
    run: str | None = None
    from_index: int | None = None
    checkpoint: CheckpointRecord | None = None
    channel: ChannelRecord | None = None
    is_litter: bool = False


def find_faults(folder: DataFolder, database: RunDatabase, with_litter: bool = True) -> Iterator[Fault]:
    """Look at every row and every file.

    Args:
        folder: the data folder.
        database: its database.
        with_litter: whether to look for files without rows, too; only while no service writes.
    """
    for sentence in database.faults():
        yield Fault(sentence)
    runs = database.runs()
    for run in runs:
        yield from _frame_faults(folder, database, run)
        yield from _channel_faults(folder, database, run)
        checkpoints = CheckpointStore(folder, database)
        for record in database.checkpoints(run.run):
            try:
                checkpoints.read(record)
            except StoreError as error:
                yield Fault(str(error), run.run, checkpoint=record)
    yield from _terrain_faults(folder, runs)
    if with_litter:
        yield from _litter(folder, database, {run.run for run in runs})


def repair(folder: DataFolder, database: RunDatabase, faults: list[Fault]) -> list[str]:
    """Mend what can be mended; nobody may use the folder meanwhile.

    Args:
        folder: the data folder, locked by the caller.
        database: its database, with an epoch of its own.
        faults: what `find_faults` found.

    Returns:
        A sentence for each thing that was done.
    """
    done = []
    first: dict[str, int] = {}
    for fault in faults:
        if fault.checkpoint is not None:
            database.delete_checkpoint(fault.checkpoint)
            done.append(f"forgot checkpoint {fault.checkpoint.name} of run {fault.run}")
        elif fault.channel is not None:
            database.delete_channel(fault.channel)
            done.append(f"forgot {fault.channel.name}")
        elif fault.run is not None and fault.from_index is not None:
            first[fault.run] = min(fault.from_index, first.get(fault.run, fault.from_index))
    for run, index in first.items():
        count = database.delete_frames_from(run, index)
        status = next(record.status for record in database.runs() if record.run == run)
        if status != STOPPED:
            database.set_status(run, PAUSED, LOST)
        done.append(f"forgot {count} frames of run {run} from index {index} on")
    known = {record.run for record in database.runs()}
    for run in known:
        mend_run(folder, database, run)
    for area in ("frames", "checkpoints"):
        for path in (folder.root / area).iterdir():
            if path.name not in known:
                shutil.rmtree(path)
    folder.remove_unfinished()
    if any(fault.is_litter for fault in faults):
        done.append("removed files without a row")
    return done


def _frame_faults(folder: DataFolder, database: RunDatabase, run: RunRecord) -> Iterator[Fault]:
    reader, due, keys = FrameReader(folder), run.branch_index, set()
    for frame in database.frames(run.run):
        if frame.index != due:
            yield Fault(f"run {run.run} has no frame {due}", run.run, from_index=due)
            return
        try:
            reader.read(frame)
        except StoreError as error:
            yield Fault(str(error), run.run, from_index=frame.index)
            return
        if frame.is_key:
            keys.add(frame.index)
        if frame.key_index not in keys:
            sentence = f"frame {frame.index} of run {run.run} lacks its key frame {frame.key_index}"
            yield Fault(sentence, run.run, from_index=frame.index)
            return
        due += 1


def _channel_faults(folder: DataFolder, database: RunDatabase, run: RunRecord) -> Iterator[Fault]:
    reader = FrameReader(folder)
    for channel in database.channels(run.run):
        try:
            reader.read(channel)
        except StoreError as error:
            yield Fault(str(error), run.run, channel=channel)


def _terrain_faults(folder: DataFolder, runs: list[RunRecord]) -> Iterator[Fault]:
    for fingerprint in sorted({run.case_fingerprint for run in runs}):
        path = folder.terrain(fingerprint)
        try:
            zstandard.ZstdDecompressor().decompress(path.read_bytes())
        except (OSError, zstandard.ZstdError) as error:
            yield Fault(f"terrain {path} cannot be read: {error}; loading its case writes it again")


def _litter(folder: DataFolder, database: RunDatabase, known: set[str]) -> Iterator[Fault]:
    for area in ("frames", "checkpoints"):
        for path in sorted((folder.root / area).iterdir()):
            if path.name not in known:
                yield Fault(f"{path} belongs to no run", is_litter=True)
    for run in sorted(known):
        ends = database.segment_ends(run)
        for path in segment_files(folder, run):
            extra = path.stat().st_size - ends.get(path.name, 0)
            if extra > 0:
                yield Fault(f"{path} has {extra} bytes without a row", run, is_litter=True)
        names = {record.name for record in database.checkpoints(run)}
        for path in sorted(folder.checkpoints(run).glob("*")):
            if path.name not in names:
                yield Fault(f"{path} has no row", run, is_litter=True)
