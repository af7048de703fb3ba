"""One case from start to end without the web: solve, then write maps, tables and a summary."""

from __future__ import annotations

import dataclasses
import json
import math
import time as clock
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from solver_service.errors import RunError
from solver_service.numerics import ShallowWaterSolver, pick_device
from solver_service.offline.output_folder import output_folder
from solver_service.offline.result_maps import write_maps
from solver_service.offline.series_tables import write_gauges, write_sections
from solver_service.offline.structure_table import StructureLog, write_structures
from solver_service.offline.summary import SmallestStep, summarise
from solver_service.offline.timesteps import NetcdfTimesteps, TimestepFacts, TimestepWriter, ZarrTimesteps
from solver_service.scenario import Case

OnFrame = Callable[[float, float], None]


@dataclass(frozen=True)
class OfflineOptions:
    """How a case is run.

    Attributes:
        until: simulated time [s]; None for the case's duration.
        out: folder of the results; None writes none.
        device: "auto", "cpu" or "cuda:N".
        threads: CPU threads; None for all cores.
        netcdf: also write every frame into timesteps.nc.
        zarr: also write every frame into timesteps.zarr.
    """

    until: float | None = None
    out: Path | None = None
    device: str = "auto"
    threads: int | None = None
    netcdf: bool = False
    zarr: bool = False


def run_case(case: Case, options: OfflineOptions, on_frame: OnFrame | None = None) -> dict[str, Any]:
    """Compute a case and write its results.

    Args:
        case: the case.
        options: how.
        on_frame: told the simulated time and the end [s] after each frame.

    Returns:
        The summary: a JSON-able mapping with the figures of the run.

    Raises:
        ServiceError: an option is not valid, the device is absent, the run blew up, or a file fails.
    """
    until = case.duration if options.until is None else options.until
    if not (math.isfinite(until) and 0.0 < until <= 1e9):
        raise RunError(f"The time to run until is {until:g} s; a time above 0, up to 1e9 s, is allowed.")
    if options.threads is not None and options.threads < 1:
        raise RunError(f"The number of threads is {options.threads}; 1 or more is allowed.")
    if (options.netcdf or options.zarr) and options.out is None:
        raise RunError("Timesteps (--netcdf, --zarr) need an output folder; give --out.")
    device = pick_device(options.device)
    if options.out is None:
        return _Run(case, device, options.threads).compute(until, [], on_frame)
    with output_folder(options.out) as folder:
        try:
            return _run_into(folder, case, device, options, until, on_frame)
        except RuntimeError as error:  # what the NetCDF library says of a full disk
            raise OSError(None, str(error)) from error


def _run_into(
    folder: Path, case: Case, device: str, options: OfflineOptions, until: float, on_frame: OnFrame | None
) -> dict[str, Any]:
    run = _Run(case, device, options.threads)
    writers: list[TimestepWriter] = []
    try:
        if options.netcdf:
            writers.append(NetcdfTimesteps(folder / "timesteps.nc", TimestepFacts.of(case)))
        if options.zarr:
            writers.append(ZarrTimesteps(folder / "timesteps.zarr", TimestepFacts.of(case)))
        summary = run.compute(until, writers, on_frame)
    finally:
        for writer in writers:
            writer.close()
    run.write(folder)
    (folder / "summary.json").write_text(json.dumps(summary, indent=2) + "\n", encoding="utf-8")
    return summary


class _Run:
    """A case on a device."""

    def __init__(self, case: Case, device: str, threads: int | None) -> None:
        self.case = case
        params = dataclasses.replace(case.params, threads=threads or case.params.threads)
        self.solver = ShallowWaterSolver(case.model, params, device)
        self.solver.set_water(case.initial_h)
        self.structures = StructureLog(case)
        self.smallest = SmallestStep(case.grid)

    def compute(
        self, until: float, writers: list[TimestepWriter], on_frame: OnFrame | None
    ) -> dict[str, Any]:
        """Compute to the end, frame by frame."""
        interval = self.case.output_interval
        frames = math.ceil(until / interval - 1e-9)
        for writer in writers:
            writer.append(0.0, self.solver.depth(), self.solver.bed)
        self.structures.record(self.solver)
        began = clock.perf_counter()
        for number in range(1, frames + 1):
            # The same product as a run of the service makes, so that both land on the same times.
            time = min(number * interval, until)
            self.solver.advance_to(time)
            for writer in writers:
                writer.append(time, self.solver.depth(), self.solver.bed)
            self.structures.record(self.solver)
            self.smallest.look(self.solver)
            if on_frame is not None:
                on_frame(time, until)
        wall_s = clock.perf_counter() - began
        return summarise(self.case, self.solver, self.smallest, frames + 1, wall_s)

    def write(self, folder: Path) -> None:
        """Write maps and tables.

        Raises:
            OSError: a file cannot be written.
        """
        series = self.solver.gauge_series()
        write_gauges(folder / "gauges.csv", self.case, series)
        ids = [section.id for section in self.case.sections]
        write_sections(folder / "sections.csv", ids, self.solver.section_series())
        write_structures(folder / "structures.csv", self.structures)
        write_maps(folder, self.case, self.solver)
