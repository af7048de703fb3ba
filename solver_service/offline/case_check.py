"""A look at a case before it is run: what stands in it, what is odd, and what it will cost."""

from __future__ import annotations

import time as clock
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from solver_service.numerics import ShallowWaterSolver, pick_device
from solver_service.numerics.allocation import MemoryOptions, allocation_table, device_bytes
from solver_service.numerics.device import thread_count
from solver_service.numerics.snapping import NORTH_FACE
from solver_service.numerics.structures import Weir
from solver_service.offline.case_features import case_features
from solver_service.scenario import Case

PROBE_S = 2.0
"""Wall time for which the solver is tried [s]."""
CARD = 24e9
"""Memory of a common graphics card [bytes]."""
DEEP_PIT = 5.0
"""A single cell this much lower than all its neighbours [m] is told as odd."""


@dataclass
class CaseReport:
    """What a check found.

    Attributes:
        facts: name and value, for people.
        warnings: one sentence each.
        figures: numbers, for programs.
    """

    facts: list[tuple[str, str]] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    figures: dict[str, float | int | str] = field(default_factory=dict)


def check_case(case: Case, device: str = "auto", probe_s: float = PROBE_S) -> CaseReport:
    """Look at a case and try its solver for two seconds.

    Args:
        case: the case.
        device: where it would run.
        probe_s: wall time for which the solver is tried [s].

    Raises:
        ServiceError: the device is absent, or the run blows up at once.
    """
    report = CaseReport(warnings=list(case.warnings))
    _look_at_ground(case, report)
    _look_at_water(case, report)
    _look_at_structures(case, report)
    chosen = pick_device(device)
    _look_at_memory(case, chosen, report)
    _try_solver(case, chosen, report, probe_s)
    return report


def _look_at_ground(case: Case, report: CaseReport) -> None:
    grid, z = case.grid, case.z_b.astype(np.float64) + case.grid.datum_offset
    blocked = case.model.blocked if case.model.blocked is not None else np.zeros(grid.shape, bool)
    xmin, ymin, xmax, ymax = grid.extent
    low, high = float(z[~blocked].min()), float(z[~blocked].max())
    pits, deepest = _pits(z, blocked)
    report.facts += [
        ("coordinates", f"{grid.crs}, metres"),
        ("vertical datum", f"{grid.vertical_datum or 'not said'} (stored from {grid.datum_offset:g} m)"),
        ("cells", f"{grid.nrows} x {grid.ncols} = {grid.cell_count} of {grid.dx:g} m"),
        ("extent", f"x {xmin:.10g} to {xmax:.10g} m, y {ymin:.10g} to {ymax:.10g} m"),
        ("elevation", f"{low:.2f} to {high:.2f} m"),
        ("cells without data", f"{case.nodata_count} ({int(blocked.sum())} walls)"),
        ("single-cell pits", f"{pits}, the deepest {deepest:.2f} m"),
    ]
    report.figures.update(
        cells=grid.cell_count, nodata=case.nodata_count, pits=pits, elevation_min_m=low, elevation_max_m=high
    )
    if deepest > DEEP_PIT:
        report.warnings.append(f"A single cell lies {deepest:.1f} m below all its neighbours.")
    if high - low > 9000.0:
        report.warnings.append(f"The ground spans {high - low:.0f} m; is the unit really metres?")
    if not grid.vertical_datum:
        report.warnings.append("[case] vertical_datum does not say what elevation 0 is.")


def _pits(z: NDArray[np.float64], blocked: NDArray[np.bool_]) -> tuple[int, float]:
    """Number of cells lower than all eight neighbours, and how far the deepest lies below them."""
    from scipy import ndimage

    ring = np.ones((3, 3), bool)
    ring[1, 1] = False
    lowest_near = ndimage.minimum_filter(np.where(blocked, np.inf, z), footprint=ring, mode="nearest")
    depth = np.where(blocked | ~np.isfinite(lowest_near), 0.0, lowest_near - z)
    inner = depth[1:-1, 1:-1]
    if inner.size == 0:
        return 0, 0.0
    return int(np.count_nonzero(inner > 0.0)), float(max(inner.max(), 0.0))


def _look_at_water(case: Case, report: CaseReport) -> None:
    area, model = case.grid.dx**2, case.model
    volume = float(case.initial_h.sum(dtype=np.float64)) * area
    open_edges = [boundary for boundary in model.boundaries if boundary.kind != "wall"]
    report.facts += [
        ("water at the start", f"{volume:.6g} m3, up to {float(case.initial_h.max()):.2f} m deep"),
        ("rain", _rain(case)),
        ("infiltration", "none" if model.infiltration is None else model.infiltration.kind),
    ]
    report.facts += [(feature.kind, f"{feature.id}: {feature.text}") for feature in case_features(case)]
    if not open_edges:
        report.facts.append(("boundary", "none (walls all around)"))
    report.facts.append(("run", f"{case.duration:g} s, a frame every {case.output_interval:g} s"))
    report.figures["volume_initial_m3"] = volume
    brings = any(boundary.kind in ("stage", "discharge") for boundary in model.boundaries)
    if volume == 0.0 and not model.sources and model.rain is None and not brings:
        report.warnings.append(
            "There is no water: no [initial], no [[source]], no [rain] and no edge that brings some."
        )
    for number, source in enumerate(model.sources, start=1):
        on_edge = (source.rows == 0) | (source.rows == case.grid.nrows - 1)
        on_edge |= (source.cols == 0) | (source.cols == case.grid.ncols - 1)
        if on_edge.any():
            report.warnings.append(f"[[source]] number {number} touches the edge of the terrain.")
    if model.blocked is not None:
        for gauge in case.gauges:
            row, col = (round(part) for part in case.grid.to_cell(gauge.x, gauge.y))
            if model.blocked[min(row, case.grid.nrows - 1), min(col, case.grid.ncols - 1)]:
                report.warnings.append(f"Gauge '{gauge.id}' stands on a cell without data.")


def _look_at_structures(case: Case, report: CaseReport) -> None:
    z_b, dx = case.model.z_b, case.grid.dx
    for built in case.model.structures:
        if isinstance(built, Weir):
            faces = built.snapped(z_b.shape, dx).faces
            levels, _ = built.face_levels(faces)
            northern = faces[:, 2] == NORTH_FACE
            rows, cols = faces[:, 0], faces[:, 1]
            beyond = z_b[rows + northern, cols + ~northern]
            if (levels <= np.maximum(z_b[rows, cols], beyond)).all():
                report.warnings.append(
                    f"The weir '{built.id}' lies below the ground everywhere: it does nothing."
                )
    for breach in case.model.breaches:
        cells = breach.snapped(z_b.shape, dx).cells
        if (z_b[cells[:, 0], cells[:, 1]] <= breach.bottom_level).all():
            report.warnings.append(
                f"The ground of the breach '{breach.id}' lies below its bottom level: it does nothing."
            )


def _rain(case: Case) -> str:
    """Largest rate, and the mean depth that falls until the end of the run."""
    rain = case.model.rain
    if rain is None:
        return "none"
    rows, cols = np.bincount(rain.row_index), np.bincount(rain.col_index)
    mean = rows @ rain.rates[:, : rows.size, : cols.size] @ cols / case.grid.cell_count
    times = np.unique(np.append(np.clip(rain.times, 0.0, case.duration), case.duration))
    if rain.interpolation == "step":
        depth = float(mean[np.searchsorted(rain.times, times[:-1], side="right") - 1] @ np.diff(times))
    else:
        depth = float(np.trapezoid(np.interp(times, rain.times, mean), times))
    cells = f"{rain.rates.shape[1]} x {rain.rates.shape[2]} rain cells"
    return f"up to {rain.rates.max() * 3.6e6:.4g} mm/h, {depth * 1e3:.4g} mm in all, {cells}"


def _look_at_memory(case: Case, device: str, report: CaseReport) -> None:
    options = MemoryOptions.of(case.model, case.params, thread_count(case.params.threads))
    table = allocation_table(case.grid.shape, options, device)
    on_card = allocation_table(case.grid.shape, options, "cuda:0")
    total, share = device_bytes(table, device), device_bytes(on_card, "cuda:0") / CARD
    report.facts.append(
        ("memory", f"{_size(total)} on {device}, {total / case.grid.cell_count:.1f} B a cell:")
    )
    for line in table:
        where = "" if line.is_on_device or device == "cpu" else ", on the host"
        report.facts.append(("", f"{line.bytes_per_cell:6.1f} B a cell  {line.name}{where}"))
    fits = (
        f"{100.0 * share:.2g} % of it"
        if share <= 1.0
        else f"this case does not fit, it takes {share:.1f} times that"
    )
    most = case.grid.cell_count / share / 1e6
    report.facts.append(("a card of 24 GB", f"{fits}; such a case fits up to {most:.0f} million cells"))
    report.figures.update(memory_bytes=total, card_24_gb_share=share, device=device)


def _size(nbytes: int) -> str:
    return f"{nbytes / 2**30:.1f} GiB" if nbytes >= 2**30 else f"{nbytes / 2**20:.1f} MiB"


def _try_solver(case: Case, device: str, report: CaseReport, probe_s: float) -> None:
    solver = ShallowWaterSolver(case.model, case.params, device)
    solver.set_water(case.initial_h)
    solver.advance_to(min(1e-3, case.duration))
    began, start = clock.perf_counter(), solver.time
    solver.advance_to(case.duration, lambda: clock.perf_counter() - began > probe_s)
    wall, simulated = clock.perf_counter() - began, solver.time - start
    estimate = wall * case.duration / simulated if simulated > 0.0 else float("inf")
    report.facts.append(
        ("time to run", f"about {estimate:.3g} s, judged by the first {simulated:.1f} s of the flood")
    )
    report.figures["run_time_s"] = estimate
    if solver.wet_cells:
        row, col = solver.limiting_cell()
        x, y = case.grid.center(row, col)
        place = f"cell (row {row}, column {col}) at x {x:.10g}, y {y:.10g} m"
        report.facts.append(("time step", f"limited by {place} then"))
