"""Polygons from GeoJSON or CSV, and which cell centres lie inside them."""

from __future__ import annotations

import csv
import json
import math
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from protocol import GridGeometry
from solver_service.errors import TerrainError

Ring = list[tuple[float, float]]
MAX_FILE_BYTES = 64 << 20
MAX_POLYGONS = 100_000


def read_polygons(path: Path) -> list[list[Ring]]:
    """Polygons of a file, each a list of rings: the outer one, then its holes.

    A .csv holds one x,y a line; several polygons stand apart by empty lines or by a first column that names
    them. A .geojson holds Polygons and MultiPolygons in the coordinates of the case (not in degrees).

    Raises:
        TerrainError: missing, unreadable, without a polygon, or a number is not finite.
    """
    if not path.is_file():
        raise TerrainError(f"Polygon file '{path.name}' does not exist in {path.parent}.")
    if path.stat().st_size > MAX_FILE_BYTES:
        raise TerrainError(f"Polygon file '{path.name}' is larger than {MAX_FILE_BYTES} bytes.")
    suffix = path.suffix.lower()
    if suffix not in (".csv", ".geojson", ".json"):
        raise TerrainError(
            f"Polygon file '{path.name}' is of no known format; .geojson and .csv are allowed."
        )
    try:
        text = path.read_text(encoding="utf-8-sig")
        polygons = _from_csv(text) if suffix == ".csv" else _from_geojson(json.loads(text))
    except (ValueError, TypeError, KeyError, RecursionError) as error:
        raise TerrainError(f"Polygon file '{path.name}' cannot be read: {error}.") from error
    if not polygons or len(polygons) > MAX_POLYGONS:
        raise TerrainError(
            f"Polygon file '{path.name}' has {len(polygons)} polygons; 1 to {MAX_POLYGONS} are allowed."
        )
    return polygons


def check_ring(points: Any) -> Ring:
    """A ring of at least three finite points whose sides do not cross each other.

    Raises:
        ValueError: it is not.
    """
    ring = [(float(point[0]), float(point[1])) for point in points]
    if not all(math.isfinite(value) for point in ring for value in point):
        raise ValueError("a coordinate is not finite")
    if len(set(ring)) < 3:
        raise ValueError(f"a polygon has {len(set(ring))} different corners, at least 3 are allowed")
    crossing = _self_crossing(np.array(ring))
    if crossing is not None:
        (xa, ya), (xb, yb) = (ring[side] for side in crossing)
        raise ValueError(
            f"a polygon crosses itself: the sides that begin at ({xa:.10g}, {ya:.10g}) and"
            f" ({xb:.10g}, {yb:.10g}) meet; corners in their order around the area are allowed"
        )
    return ring


def _self_crossing(ring: NDArray[np.float64]) -> tuple[int, int] | None:
    """Two sides that pass through each other (touching is no crossing), None where none do."""
    ends = np.roll(ring, -1, axis=0)
    low, high = np.minimum(ring, ends), np.maximum(ring, ends)
    order = np.argsort(low[:, 0], kind="stable")
    starts = low[order, 0]
    for place, side in enumerate(order.tolist()):
        # Sides further on in the order that begin west of where this one ends.
        near = order[place + 1 : np.searchsorted(starts, high[side, 0], side="right")]
        near = near[(low[near, 1] <= high[side, 1]) & (high[near, 1] >= low[side, 1])]
        if near.size == 0:
            continue
        a, b, c, d = ring[side], ends[side], ring[near], ends[near]
        apart = _turn(a, b, c) * _turn(a, b, d) < 0.0
        apart &= _turn(c, d, a) * _turn(c, d, b) < 0.0
        if apart.any():
            return side, int(near[apart][0])
    return None


def _turn(a: NDArray[np.float64], b: NDArray[np.float64], c: NDArray[np.float64]) -> NDArray[np.float64]:
    """Sign of the side of the line from a to b on which c lies: 1 left, -1 right, 0 on it."""
    ab, ac = b - a, c - a
    sign: NDArray[np.float64] = np.sign(ab[..., 0] * ac[..., 1] - ab[..., 1] * ac[..., 0])
    return sign


def _from_csv(text: str) -> list[list[Ring]]:
    groups: list[list[tuple[float, float]]] = [[]]
    label: str | None = None
    for number, row in enumerate(csv.reader(text.splitlines()), start=1):
        cells = [cell.strip() for cell in row]
        if not any(cells):
            groups.append([])
            continue
        try:
            point = (float(cells[-2]), float(cells[-1]))
        except (ValueError, IndexError) as error:
            if number == 1:
                continue
            raise ValueError(f"line {number} '{','.join(row)}' does not end in x,y") from error
        if len(cells) > 2 and cells[0] != label:
            label = cells[0]
            groups.append([])
        groups[-1].append(point)
    return [[check_ring(group)] for group in groups if group]


def _from_geojson(node: Any) -> list[list[Ring]]:
    kind = node["type"]
    if kind == "FeatureCollection":
        return [polygon for feature in node["features"] for polygon in _from_geojson(feature)]
    if kind == "Feature":
        return _from_geojson(node["geometry"])
    if kind == "GeometryCollection":
        return [polygon for part in node["geometries"] for polygon in _from_geojson(part)]
    if kind == "Polygon":
        return [[check_ring(ring) for ring in node["coordinates"]]]
    if kind == "MultiPolygon":
        return [[check_ring(ring) for ring in polygon] for polygon in node["coordinates"]]
    raise ValueError(f"it holds a '{kind}', only Polygon and MultiPolygon are allowed")


def cells_inside(polygons: list[list[Ring]], grid: GridGeometry) -> NDArray[np.bool_]:
    """Cells whose centre lies inside any of the polygons [nrows, ncols]."""
    inside = np.zeros(grid.shape, bool)
    for rings in polygons:
        xs = [x for ring in rings for x, _ in ring]
        ys = [y for ring in rings for _, y in ring]
        row0, col0 = grid.to_cell(min(xs), min(ys))
        row1, col1 = grid.to_cell(max(xs), max(ys))
        r0, r1 = max(0, math.ceil(row0)), min(grid.nrows, math.floor(row1) + 1)
        c0, c1 = max(0, math.ceil(col0)), min(grid.ncols, math.floor(col1) + 1)
        if r1 <= r0 or c1 <= c0:
            continue
        x = grid.x0 + (np.arange(c0, c1) + 0.5) * grid.dx
        y = grid.y0 + (np.arange(r0, r1) + 0.5) * grid.dx
        odd = np.zeros((r1 - r0, c1 - c0), bool)
        for ring in rings:
            for (xa, ya), (xb, yb) in zip(ring, ring[1:] + ring[:1], strict=True):
                if ya == yb:
                    continue
                crosses = (ya <= y) != (yb <= y)
                at = xa + (y[crosses] - ya) * (xb - xa) / (yb - ya)
                odd[crosses] ^= x[None, :] < at[:, None]
        inside[r0:r1, c0:c1] |= odd
    return inside
