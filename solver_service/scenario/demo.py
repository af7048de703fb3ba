"""[demo] and [[demo.edit]]: what a tour of the case may show."""

from __future__ import annotations

from protocol import EditError, EditLine, EditType, GridGeometry, Operation, check_edit
from solver_service.errors import CaseError
from solver_service.scenario.case import DemoScript
from solver_service.scenario.table import Table


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
