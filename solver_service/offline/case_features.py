"""Where what a case builds lies on the grid: sources, edges, structures, breaches, gauges and sections.

Each feature is a sentence for people and a GeoJSON feature, in the coordinates of the terrain, for a map: the
cells and faces that the solver takes, not the lines that were drawn.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from protocol import GridGeometry
from solver_service.errors import RunError
from solver_service.numerics import EdgeBoundary, Source
from solver_service.numerics.breach import Breach
from solver_service.numerics.snapping import Snapped
from solver_service.numerics.structures import Culvert, Pump, Weir
from solver_service.scenario import Case

SIDES = (", east", ", north")
"""Which side of its cell a face is."""


@dataclass(frozen=True)
class Feature:
    """Something on the grid.

    Attributes:
        kind: source, boundary, weir, culvert, pump, breach, gauge or section.
        id: its name.
        text: what it is and where it lies, for people.
        geometry: GeoJSON geometry [m].
    """

    kind: str
    id: str
    text: str
    geometry: dict[str, Any]


def case_features(case: Case) -> list[Feature]:
    """All features of a case, in the order of the case file."""
    grid, model = case.grid, case.model
    found = [_boundary(boundary, grid) for boundary in model.boundaries]
    found += [_source(source, grid) for source in model.sources]
    for built in (*model.structures, *model.breaches):
        snapped = built.snapped(grid.shape, grid.dx)
        kind = type(built).__name__.lower()
        text = f"{_describe(built, grid)}; {_where(snapped)}"
        found.append(Feature(kind, built.id, text, _geometry(snapped, grid)))
    for gauge, (col, row) in zip(case.gauges, case.params.gauges, strict=True):
        text = f"cell (row {row:g}, column {col:g})"
        found.append(Feature("gauge", gauge.id, text, {"type": "Point", "coordinates": [gauge.x, gauge.y]}))
    for section in case.sections:
        snapped = section.snapped(grid.shape)
        found.append(Feature("section", section.id, _where(snapped), _geometry(snapped, grid)))
    return found


def write_geojson(path: Path, case: Case) -> None:
    """Write the features as GeoJSON in the coordinates of the terrain, with its system named.

    Raises:
        RunError: the file cannot be written.
    """
    collection: dict[str, Any] = {
        "type": "FeatureCollection",
        "features": [
            {
                "type": "Feature",
                "properties": {"kind": feature.kind, "id": feature.id, "text": feature.text},
                "geometry": feature.geometry,
            }
            for feature in case_features(case)
        ],
    }
    if case.grid.crs.upper().startswith("EPSG:"):
        name = f"urn:ogc:def:crs:EPSG::{case.grid.crs[5:]}"
        collection["crs"] = {"type": "name", "properties": {"name": name}}
    try:
        path.write_text(json.dumps(collection) + "\n", encoding="utf-8")
    except OSError as error:
        raise RunError(f"The file '{path}' cannot be written: {error.strerror}.") from error


def _describe(built: Weir | Culvert | Pump | Breach, grid: GridGeometry) -> str:
    datum = grid.datum_offset
    if isinstance(built, Weir):
        crest = np.atleast_1d(built.crest) + datum
        return (
            f"crest {crest.min():.2f} to {crest.max():.2f} m" if np.ptp(crest) else f"crest {crest[0]:.2f} m"
        )
    if isinstance(built, Culvert):
        return (
            f"{built.barrels} x {built.width:.2f} m by {built.height:.2f} m, {built.length:.1f} m long, floor"
            f" {built.invert_inlet + datum:.2f} to {built.invert_outlet + datum:.2f} m"
        )
    if isinstance(built, Pump):
        target = "out of the terrain" if built.outlet is None else "to its outlet"
        return f"up to {max(built.discharge):g} m3/s {target}"
    when = f"at {built.start_time:g} s" if built.start == "time" else "when overtopped"
    return (
        f"starts {when}, crest {built.crest + datum:.2f} m, down to {built.bottom_level + datum:.2f} m in"
        f" {built.duration:g} s, up to {built.widest(grid.dx):.1f} m wide"
    )


def _where(snapped: Snapped) -> str:
    """Which cells and faces were taken, the first and the last of many."""
    parts = []
    for what, items in (("cell", snapped.cells), ("face", snapped.faces)):
        if len(items) == 0:
            continue
        shown = [
            f"(row {row}, column {col}{''.join(SIDES[side] for side in sides)})"
            for row, col, *sides in items.tolist()
        ]
        named = " ".join(shown) if len(shown) <= 4 else f"{shown[0]} to {shown[-1]}"
        parts.append(f"{len(items)} {what}{'s' if len(items) > 1 else ''} {named}")
    return ", ".join(parts)


def _boundary(boundary: EdgeBoundary, grid: GridGeometry) -> Feature:
    span = f"{boundary.edge}, cells {boundary.first} to {boundary.last - 1}"
    if boundary.kind == "stage" and boundary.values is not None:
        levels = boundary.values + grid.datum_offset
        span += f", level {levels.min():.2f} to {levels.max():.2f} m"
    elif boundary.kind == "discharge" and boundary.values is not None:
        span += f", {boundary.values.min():g} to {boundary.values.max():g} m3/s"
    elif boundary.kind == "normal_depth":
        span += f", slope {boundary.slope:g}"
    xmin, ymin, xmax, ymax = grid.extent
    low, high = boundary.first * grid.dx, boundary.last * grid.dx
    ends = {
        "west": [[xmin, ymin + low], [xmin, ymin + high]],
        "east": [[xmax, ymin + low], [xmax, ymin + high]],
        "south": [[xmin + low, ymin], [xmin + high, ymin]],
        "north": [[xmin + low, ymax], [xmin + high, ymax]],
    }[boundary.edge]
    line = {"type": "LineString", "coordinates": ends}
    return Feature("boundary", boundary.id, f"{boundary.kind} in the {span}", line)


def _source(source: Source, grid: GridGeometry) -> Feature:
    cells = np.column_stack([source.rows, source.cols])
    volume = float(np.trapezoid(source.discharge, source.times))
    text = f"up to {source.discharge.max():g} m3/s"
    text += f", {volume:.6g} m3 in its series" if source.times.size > 1 else ""
    snapped = Snapped(cells, np.zeros((0, 3), np.int32))
    return Feature("source", source.id, f"{text}; {_where(snapped)}", _geometry(snapped, grid))


def _geometry(snapped: Snapped, grid: GridGeometry) -> dict[str, Any]:
    """Squares of the cells, else lines along the faces."""
    if len(snapped.faces):
        lines = [[list(grid.center(row, col)) for col, row in ends] for ends in snapped.face_lines().tolist()]
        return {"type": "MultiLineString", "coordinates": lines}
    return {
        "type": "MultiPolygon",
        "coordinates": [list(_square(cell, grid)) for cell in snapped.cells.tolist()],
    }


def _square(cell: list[int], grid: GridGeometry) -> Iterator[list[list[float]]]:
    row, col = cell
    x, y, dx = grid.x0 + col * grid.dx, grid.y0 + row * grid.dx, grid.dx
    yield [[x, y], [x + dx, y], [x + dx, y + dx], [x, y + dx], [x, y]]
