"""Places of a case that are watched or shown: gauges, sections, and the tour."""

from __future__ import annotations

import math

from protocol import EditError, EditLine, EditType, GridGeometry, Operation, check_edit
from solver_service.errors import CaseError
from solver_service.scenario.case import DemoScript, Gauge, Section
from solver_service.scenario.case_folder import CaseFolder
from solver_service.scenario.series import read_points
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


def read_demo(table: Table | None, grid: GridGeometry) -> DemoScript | None:
    """The tour of a case; None where nothing is said.

    Raises:
        CaseError: an edit does not fit the terrain.
    """
    if table is None:
        return None
    time = table.real("time", "a time in s at or above 0", 0.0, 1e12, default=0.0)
    target = table.point("target") if table.has("target") else None
    edits = []
    for number, item in enumerate(table.tables("edit"), start=1):
        operation = item.choice("operation", [option.value for option in Operation], "raise")
        kind = item.choice("type", [option.value for option in EditType], "modulate")
        try:
            edit = EditLine(
                id=f"demo-{number}",
                vertices=item.points("line", 2),
                width=item.real("width", "a width in m above 0", 0.0, 1e5, above=True),
                operation=Operation(operation),
                type=EditType(kind),
                magnitude=item.real("magnitude", "a height in m above 0", 0.0, 1e4, above=True),
                level=item.number_or_none("level", "an elevation in m", -20_000.0, 20_000.0),
            )
            check_edit(edit, grid)
        except (EditError, ValueError) as error:
            raise CaseError(f"{item.file}: [[demo.edit]] number {number}: {error}") from error
        edits.append(edit)
    return DemoScript(time, target, tuple(edits))


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
