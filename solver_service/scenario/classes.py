"""Values by class: a raster of whole numbers (land cover, soil) and a CSV that says what each class means."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from solver_service.errors import CaseError
from solver_service.scenario.csv_file import read_csv
from solver_service.scenario.inputs import Inputs
from solver_service.scenario.table import Table

MAX_CLASSES = 10_000


def read_classes(
    table: Table, inputs: Inputs, limits: Mapping[str, tuple[float, float]]
) -> tuple[NDArray[np.int32], dict[str, NDArray[np.float64]]]:
    """Which line of the CSV counts for each cell, and the values of the lines.

    Args:
        table: a table with `classes` (a raster) and `table` (a CSV with the column `class`).
        inputs: files and grid.
        limits: columns to read, with their smallest and largest value; other columns are left alone.

    Returns:
        Line of each cell [nrows, ncols], and the values of each column [lines].

    Raises:
        CaseError: a cell has no class, a class is no whole number or not in the table, or a value is wrong.
        TerrainError: the raster is not valid.
    """
    path = inputs.file(table, "table")
    columns, lines = read_csv(path)
    missing = [name for name in ("class", *limits) if name not in columns]
    if missing:
        raise CaseError(
            f"{path.name}: line 1 names no column '{missing[0]}'; {', '.join(('class', *limits))} are needed."
        )
    if not 1 <= len(lines) <= MAX_CLASSES:
        raise CaseError(f"{path.name}: has {len(lines)} classes; 1 to {MAX_CLASSES} are allowed.")
    codes: list[int] = []
    for line in lines:
        code = line.real("class", -1e9, 1e9)
        if code != round(code) or round(code) in codes:
            raise line.wrong(f"has the class {code:g}; a whole number of its own is allowed")
        codes.append(round(code))
    values = {name: np.array([line.real(name, *bounds) for line in lines]) for name, bounds in limits.items()}
    raster = inputs.raster(table, "classes", "classes", "nearest")
    return _lines_of(table, raster, inputs.terrain.wall, np.array(codes), path.name), values


def _lines_of(
    table: Table,
    raster: NDArray[np.float32],
    wall: NDArray[np.bool_],
    codes: NDArray[np.int64],
    csv_name: str,
) -> NDArray[np.int32]:
    """Index of the class of each cell; that of a wall is 0."""
    order = np.argsort(codes)
    at = np.clip(np.searchsorted(codes[order], np.nan_to_num(raster, nan=0.0)), 0, codes.size - 1)
    known = codes[order][at] == raster
    bad = ~known & ~wall
    if bad.any():
        row, col = np.argwhere(bad)[0].tolist()
        value = raster[row, col]
        said = "no class" if np.isnan(value) else f"the class {value:g}"
        raise table.wrong(
            "classes", f"cell (row {row}, column {col}) holds {said}; a class of {csv_name} is allowed"
        )
    return np.where(known, order[at], 0).astype(np.int32)
