"""[[boundary]]: what happens along the edges; where nothing is said stands a wall."""

from __future__ import annotations

from typing import Literal, cast

import numpy as np

from solver_service.errors import CaseError
from solver_service.numerics import EdgeBoundary
from solver_service.numerics.edge_boundary import EDGES, Edge
from solver_service.scenario.initial import check_level
from solver_service.scenario.inputs import Inputs
from solver_service.scenario.keys import BOUNDARY_KINDS
from solver_service.scenario.quantities import EDGE_DISCHARGE, LEVEL
from solver_service.scenario.series import Series
from solver_service.scenario.table import Table

Kind = Literal["wall", "open", "stage", "discharge", "normal_depth"]
DISCHARGE_PER_WIDTH_MAX = 1000.0
"""A larger inflow per metre of width [m2/s] is refused: the Amazon has about 100."""
SLOPE = "a bed slope above 0, up to 1,"
KEYS_OF_KIND: dict[str, frozenset[str]] = {
    "wall": frozenset(),
    "open": frozenset(),
    "stage": frozenset({"level", "series"}),
    "discharge": frozenset({"discharge", "series"}),
    "normal_depth": frozenset({"slope"}),
}


def read_boundaries(tables: list[Table], inputs: Inputs) -> tuple[EdgeBoundary, ...]:
    """Edge segments in their order, each with an id.

    Raises:
        CaseError: a key is not valid, a segment lies off its edge or on another one, or a series is absurd.
    """
    boundaries: list[EdgeBoundary] = []
    for table in tables:
        edge = cast(Edge, table.choice("edge", EDGES))
        kind = cast(Kind, table.choice("kind", BOUNDARY_KINDS, "wall"))
        for key in ("level", "discharge", "series", "slope"):
            if table.has(key) and key not in KEYS_OF_KIND[kind]:
                raise table.wrong(key, f"it is not allowed where kind is '{kind}'")
        first, last = _cells(table, edge, inputs)
        _check_apart(table, edge, first, last, boundaries, inputs)
        number = 1 + sum(other.edge == edge for other in boundaries)
        name = table.text("id", f"{edge}-{number}", longest=64)
        series = _series(table, kind, edge, first, last, inputs)
        boundaries.append(
            EdgeBoundary(
                edge,
                kind,
                first,
                last,
                id=name,
                times=None if series is None else series.times,
                values=None if series is None else series.values,
                slope=table.real("slope", SLOPE, 0.0, 1.0, above=True) if kind == "normal_depth" else None,
            )
        )
    return tuple(boundaries)


def _start(edge: Edge, inputs: Inputs) -> tuple[float, int]:
    """Where the edge begins [m] and how many cells it has."""
    grid = inputs.grid
    return (grid.y0, grid.nrows) if edge in ("west", "east") else (grid.x0, grid.ncols)


def _cells(table: Table, edge: Edge, inputs: Inputs) -> tuple[int, int]:
    dx = inputs.grid.dx
    start, count = _start(edge, inputs)
    stop = start + count * dx
    span = f"a coordinate in m along the edge, {start:.10g} to {stop:.10g},"
    low = table.real("from", span, start, stop, default=start)
    high = table.real("to", span, start, stop, default=stop)
    first, last = max(0, round((low - start) / dx)), min(count, round((high - start) / dx))
    if last <= first:
        raise table.wrong("to", f"a segment of at least one cell ({dx:g} m) is allowed")
    return first, last


def _check_apart(
    table: Table, edge: Edge, first: int, last: int, others: list[EdgeBoundary], inputs: Inputs
) -> None:
    start, _ = _start(edge, inputs)
    for number, other in enumerate(others, start=1):
        low, high = max(first, other.first), min(last, other.last)
        if other.edge == edge and low < high:
            dx = inputs.grid.dx
            raise CaseError(
                f"{table.file}: [[boundary]] number {table.number} and number {number} both hold the"
                f" {edge}ern edge from {start + low * dx:.10g} to {start + high * dx:.10g} m; segments that"
                " do not overlap are allowed, so change from and to."
            )


def _series(table: Table, kind: Kind, edge: Edge, first: int, last: int, inputs: Inputs) -> Series | None:
    if kind == "stage":
        found = inputs.series(table, "level", LEVEL)
        key = "level" if table.has("level") else "series"
        check_level(table, key, float(found.values.max()), inputs)
        bed = _edge_bed(edge, first, last, inputs)
        if float(found.values.max()) <= bed:
            inputs.warnings.append(
                f"{table.label} holds a level of at most {float(found.values.max()):g} m, below the lowest"
                f" ground of its edge ({bed:.2f} m): it never lets water in."
            )
        return Series(found.times, found.values - inputs.grid.datum_offset)
    if kind == "discharge":
        found = inputs.series(table, "discharge", EDGE_DISCHARGE)
        per_width = float(np.abs(found.values).max()) / ((last - first) * inputs.grid.dx)
        if per_width > DISCHARGE_PER_WIDTH_MAX:
            raise table.wrong(
                "discharge" if table.has("discharge") else "series",
                f"it brings {per_width:g} m2/s per metre of width; up to {DISCHARGE_PER_WIDTH_MAX:g} m2/s is"
                " allowed, so check the unit or make the segment longer",
            )
        return found
    return None


def _edge_bed(edge: Edge, first: int, last: int, inputs: Inputs) -> float:
    """Lowest ground of a segment [m]; infinite where it is all wall."""
    z = np.where(inputs.terrain.wall, np.inf, inputs.terrain.z_b)
    side = {"west": z[:, 0], "east": z[:, -1], "south": z[0], "north": z[-1]}[edge]
    return float(side[first:last].min()) + inputs.grid.datum_offset
