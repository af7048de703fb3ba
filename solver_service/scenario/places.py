"""Places that are watched: [[gauge]], the file `gauges`, and [[section]]."""

from __future__ import annotations

import math
from pathlib import Path

from protocol import GridGeometry
from solver_service.errors import CaseError
from solver_service.numerics import FloodModel
from solver_service.numerics.breach import Breach
from solver_service.numerics.section import Section
from solver_service.numerics.structures import Weir
from solver_service.scenario.case import Gauge
from solver_service.scenario.case_folder import CaseFolder
from solver_service.scenario.csv_file import read_csv
from solver_service.scenario.inputs import Inputs
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


def read_sections(tables: list[Table], inputs: Inputs) -> tuple[Section, ...]:
    """Sections, as lines in cells.

    Raises:
        CaseError: an id stands twice, or a section leaves the terrain.
        ModelError: a section is too short to take a face between two cells.
    """
    sections: list[Section] = []
    for table in tables:
        name = table.text("id", longest=64)
        if not name or "\n" in name or any(section.id == name for section in sections):
            raise table.wrong("id", "a name of its own is allowed")
        section = Section(name, inputs.line(table, "line"))
        section.chain(inputs.grid.shape)
        sections.append(section)
    return tuple(sections)


def structure_sections(model: FloodModel) -> tuple[Section, ...]:
    """Sections that tell what passes each weir and breach of a model, along their lines."""
    watched: list[Weir | Breach] = [built for built in model.structures if isinstance(built, Weir)]
    watched += model.breaches
    return tuple(Section(structure_section(built), built.vertices) for built in watched)


def structure_section(built: Weir | Breach) -> str:
    """Name of the section along a weir or breach; no section of a case has a name of two lines."""
    return f"{type(built).__name__.lower()}\n{built.id}"


def gauge_cells(gauges: tuple[Gauge, ...], grid: GridGeometry) -> tuple[tuple[float, float], ...]:
    """Column and row of the cell of each gauge."""
    cells = []
    for gauge in gauges:
        row, col = grid.to_cell(gauge.x, gauge.y)
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
    return [(line.text("id"), line.real(x, -1e9, 1e9), line.real(y, -1e9, 1e9)) for line in lines]
