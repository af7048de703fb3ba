"""Places that are watched: [[gauge]], the file `gauges`, and [[section]]."""

from __future__ import annotations

import math
from pathlib import Path

from protocol import GridGeometry
from solver_service.errors import CaseError
from solver_service.scenario.case import Gauge, Section
from solver_service.scenario.case_folder import CaseFolder
from solver_service.scenario.csv_file import read_csv
from solver_service.scenario.table import Table

MAX_GAUGES = 10_000


def read_gauges(top: Table, folder: CaseFolder, grid: GridGeometry) -> tuple[Gauge, ...]:
    """Gauges of [[gauge]] and of the file named by `gauges`.

    Raises:
        CaseError: an id stands twice, or a gauge lies outside the terrain.
    """
    gauges = [Gauge(table.text("id", longest=64), *table.point("at")) for table in top.tables("gauge")]
    if top.has("gauges"):
        path = folder.find(top.text("gauges"), f"{top.file}: gauges")
        gauges += [Gauge(name, x, y) for name, x, y in read_points(path)]
    if len(gauges) > MAX_GAUGES:
        raise CaseError(f"{top.file}: has {len(gauges)} gauges; up to {MAX_GAUGES} are allowed.")
    seen = set()
    for gauge in gauges:
        if not gauge.id or gauge.id in seen:
            raise CaseError(
                f"{top.file}: gauge id '{gauge.id}' is empty or stands twice; each its own is allowed."
            )
        seen.add(gauge.id)
        _check_inside(top.file, f"gauge '{gauge.id}'", gauge.x, gauge.y, grid)
    return tuple(gauges)


def read_sections(tables: list[Table], grid: GridGeometry) -> tuple[Section, ...]:
    """Sections, sampled along their lines.

    Raises:
        CaseError: an id stands twice, or a section leaves the terrain.
    """
    sections: list[Section] = []
    for table in tables:
        name = table.text("id", longest=64)
        if not name or any(section.id == name for section in sections):
            raise table.wrong("id", "a name of its own is allowed")
        line = table.points("line", 2)
        for x, y in line:
            _check_inside(table.file, f"section '{name}'", x, y, grid)
        if len(set(line)) < 2:
            raise table.wrong("line", "a line of some length is allowed")
        sections.append(Section.along(name, line, grid.dx))
    return tuple(sections)


def gauge_cells(
    gauges: tuple[Gauge, ...], sections: tuple[Section, ...], grid: GridGeometry
) -> tuple[tuple[float, float], ...]:
    """Column and row, in cells, of all places that the solver records: gauges, then section points."""
    places = [(gauge.x, gauge.y) for gauge in gauges]
    for section in sections:
        places += zip(section.x.tolist(), section.y.tolist(), strict=True)
    cells = []
    for x, y in places:
        row, col = grid.to_cell(x, y)
        cells.append(
            (
                float(min(max(math.floor(col + 0.5), 0), grid.ncols - 1)),
                float(min(max(math.floor(row + 0.5), 0), grid.nrows - 1)),
            )
        )
    return tuple(cells)


def _check_inside(file: str, what: str, x: float, y: float, grid: GridGeometry) -> None:
    if not grid.contains(x, y):
        xmin, ymin, xmax, ymax = grid.extent
        raise CaseError(
            f"{file}: {what} is at ({x:g}, {y:g}), outside the terrain; x {xmin:g} to {xmax:g} and"
            f" y {ymin:g} to {ymax:g} m are allowed."
        )


def read_points(path: Path) -> list[tuple[str, float, float]]:
    """Named points from a CSV whose header names `id` and x, y (or x_m, y_m).

    Raises:
        CaseError: naming file, line, and what is allowed.
    """
    columns, lines = read_csv(path)
    x, y = (name if name in columns else f"{name}_m" for name in ("x", "y"))
    missing = [name for name in ("id", x, y) if name not in columns]
    if missing:
        raise CaseError(f"{path.name}: line 1 names no column '{missing[0]}'; id, x, y are needed.")
    return [(line.cells["id"], line.real(x, -1e9, 1e9), line.real(y, -1e9, 1e9)) for line in lines]
