"""`fev-solver export`: the stored frames of a run, from the root of its tree on, as NetCDF or Zarr."""

from __future__ import annotations

from pathlib import Path

from protocol import FrameDecoder, ProtocolError, apply_edits, decode_terrain, unpack_frame
from solver_service.errors import StoreError
from solver_service.offline import NetcdfTimesteps, TimestepFacts, ZarrTimesteps, output_folder
from solver_service.runs.case_facts import CaseFacts
from solver_service.runs.edit_blobs import unpack_edits
from solver_service.store import (
    DataFolder,
    FrameReader,
    FrameRecord,
    RunDatabase,
    RunRecord,
    default_data_dir,
    load_bed,
)


def export_run(run_id: str, out: Path, data_dir: Path | None, zarr: bool) -> None:
    """Write timesteps.nc or timesteps.zarr into a folder; depths are those that viewers were sent.

    Args:
        run_id: id of the run.
        out: folder of the results.
        data_dir: the service's data folder; None for the user's.
        zarr: Zarr instead of NetCDF.

    Raises:
        ServiceError: there is no such run, its frames are damaged, or the folder cannot be written.
    """
    root = data_dir or default_data_dir()
    if not (root / "runs.sqlite").is_file():
        raise StoreError(f"The data folder '{root}' holds no runs.")
    folder = DataFolder(root)
    database = RunDatabase(folder.database)
    try:
        runs = {record.run: record for record in database.runs()}
        if run_id not in runs:
            raise StoreError(f"There is no run '{run_id}'; {', '.join(sorted(runs)) or 'none'} is stored.")
        frames = _frames_of(run_id, runs, database)
        if not frames:
            raise StoreError(f"Run '{run_id}' has no frame yet.")
        written = _write(runs, run_id, frames, folder, out, zarr)
    finally:
        database.close()
    print(f"{len(frames)} frames of run {run_id} in {written}")


def _frames_of(run_id: str, runs: dict[str, RunRecord], database: RunDatabase) -> list[FrameRecord]:
    """Rows of all frames of a run, those before its branch from the ancestors that computed them."""
    frames: list[FrameRecord] = []
    end: int | None = None
    name: str | None = run_id
    while name is not None:
        record = runs[name]
        own = [row for row in database.frames(name) if end is None or row.index < end]
        frames = [row for row in own if row.index >= record.branch_index] + frames
        end = record.branch_index if end is None else min(end, record.branch_index)
        name = record.parent
    return frames


def _write(
    runs: dict[str, RunRecord],
    run_id: str,
    frames: list[FrameRecord],
    folder: DataFolder,
    out: Path,
    zarr: bool,
) -> Path:
    run = runs[run_id]
    facts = CaseFacts.unpack(run.facts)
    grid = facts.grid.geometry
    name = "timesteps.zarr" if zarr else "timesteps.nc"
    reader = FrameReader(folder)
    try:
        base = decode_terrain(load_bed(folder, run.case_fingerprint), grid.shape)
        beds = {
            name: apply_edits(base, unpack_edits(runs[name].bed_edits), grid).z_b
            for name in {row.run for row in frames} | {run_id}
        }
        about = TimestepFacts(
            grid,
            beds[run_id],
            run.title,
            facts.source,
            facts.licence,
            facts.hypothetical,
            facts.start_time,
            facts.depth_wet,
        )
        with output_folder(out) as scratch:
            writer = ZarrTimesteps(scratch / name, about) if zarr else NetcdfTimesteps(scratch / name, about)
            decoder = FrameDecoder(grid)
            try:
                for row in frames:
                    frame = decoder.decode(unpack_frame(reader.read(row)))
                    bed = beds[row.run].copy()
                    bed.flat[frame.bed_cells] = frame.bed_values
                    writer.append(row.time, frame.h, bed)
            finally:
                writer.close()
    except ProtocolError as error:
        raise StoreError(f"Run '{run.run}' cannot be exported: {error}") from error
    return out / name
