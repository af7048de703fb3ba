"""What the readers of all tables share: the files, the ground, the clock, and the list of odd things."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from protocol import GridGeometry
from solver_service.errors import CaseError, TerrainError
from solver_service.scenario.case_folder import CaseFolder
from solver_service.scenario.quantities import Quantity
from solver_service.scenario.series import Series, odd_things, read_series
from solver_service.scenario.table import Table
from solver_service.terrain import (
    Raster,
    Ring,
    Terrain,
    cells_inside,
    check_ring,
    read_dem,
    read_polygons,
    same_crs,
    sample,
)


@dataclass(frozen=True)
class Inputs:
    """What a table may ask for beside its own keys.

    Attributes:
        folder: the files of the case.
        terrain: the ground.
        start_time: clock time of time 0; None where the case has none.
        duration: of the run [s].
        warnings: sentences about what is allowed and yet odd; readers add to it.
    """

    folder: CaseFolder
    terrain: Terrain
    start_time: datetime | None
    duration: float
    warnings: list[str] = field(default_factory=list)

    @property
    def grid(self) -> GridGeometry:
        """Where the cells are."""
        return self.terrain.grid

    def file(self, table: Table, key: str) -> Path:
        """The file that a key names.

        Raises:
            CaseError: there is no such file in the folder of the case.
        """
        return self.folder.find(table.text(key), f"{table.file}: {table.label} {key}")

    def series(
        self, table: Table, constant: str, quantity: Quantity, unit: str | None = None, key: str = "series"
    ) -> Series:
        """Values against time [SI], of a file or one number for all times.

        Args:
            table: the table.
            constant: key of the number, instead of `key`.
            quantity: what the values are.
            unit: unit of both, as the case declares it; None where it does not.
            key: key of the file.

        Raises:
            CaseError: both or none are given, or one is not valid.
        """
        unit_said = unit or quantity.unit
        if table.has(constant) == table.has(key):
            raise table.wrong(
                constant, f"either '{constant}' in {unit_said} or '{key}' (a CSV file) is needed"
            )
        if table.has(constant):
            scale = quantity.units[quantity.unit] / quantity.units[unit_said]
            low, high = quantity.low * scale, quantity.high * scale
            what = f"a {quantity.name} in {unit_said} from {low:g} to {high:g}"
            found = Series.constant(table.real(constant, what, low, high) * quantity.units[unit_said])
            name = f"{table.file}: {table.label} {constant}"
        else:
            path = self.file(table, key)
            found = read_series(path, self.start_time, quantity, unit)
            name = path.name
        self.warnings.extend(odd_things(name, found, quantity, self.duration))
        return found

    def cell(self, table: Table, key: str) -> tuple[int, int]:
        """Row and column of the cell that holds a point.

        Raises:
            CaseError: the point lies outside the terrain.
        """
        x, y = table.point(key)
        return self.cell_at(table, key, x, y)

    def cell_at(self, table: Table, key: str, x: float, y: float) -> tuple[int, int]:
        """Row and column of the cell at (x, y) [m], a point that a key gave.

        Raises:
            CaseError: the point lies outside the terrain.
        """
        grid = self.grid
        if not grid.contains(x, y):
            xmin, ymin, xmax, ymax = grid.extent
            raise table.wrong(
                key,
                f"({x:.10g}, {y:.10g}) lies off the terrain; x {xmin:.10g} to {xmax:.10g} and y {ymin:.10g}"
                f" to {ymax:.10g} m are allowed",
            )
        row, col = grid.to_cell(x, y)
        return min(max(round(row), 0), grid.nrows - 1), min(max(round(col), 0), grid.ncols - 1)

    def disc(self, table: Table, key: str, radius: float) -> tuple[tuple[int, int], ...]:
        """Cells with data whose centres lie within a radius [m] of a point, that of the point included.

        Raises:
            CaseError: the point lies outside the terrain or on a wall.
        """
        grid, wall = self.grid, self.terrain.wall
        x, y = table.point(key)
        row, col = self.cell(table, key)
        reach = min(math.ceil(radius / grid.dx), max(grid.shape))
        rows = np.arange(max(0, row - reach), min(grid.nrows, row + reach + 1))
        cols = np.arange(max(0, col - reach), min(grid.ncols, col + reach + 1))
        dy = grid.y0 + (rows[:, None] + 0.5) * grid.dx - y
        dx = grid.x0 + (cols[None, :] + 0.5) * grid.dx - x
        within = (dx * dx + dy * dy <= radius * radius) | ((rows[:, None] == row) & (cols[None, :] == col))
        within &= ~wall[np.ix_(rows, cols)]
        if not within.any():
            raise table.wrong(key, "a place with terrain data is allowed")
        return tuple((int(rows[r]), int(cols[c])) for r, c in np.argwhere(within))

    def line(self, table: Table, key: str) -> tuple[tuple[float, float], ...]:
        """Vertices (column, row) of a line in cells from the centre of cell (0, 0).

        Raises:
            CaseError: a point lies outside the terrain, or equals the one before it.
        """
        points = table.points(key, 2)
        if any(a == b for a, b in itertools.pairwise(points)):
            raise table.wrong(key, "a line whose points differ each from the one before is allowed")
        vertices = []
        for x, y in points:
            self.cell_at(table, key, x, y)
            row, col = self.grid.to_cell(x, y)
            vertices.append((col, row))
        return tuple(vertices)

    def raster(
        self, table: Table, key: str, array: str, kind: Literal["nearest", "linear"]
    ) -> NDArray[np.float32]:
        """A raster file on the cells of the terrain; NaN where it says nothing.

        Args:
            table: the table; its key `row0` counts for a .npz.
            key: key of the file.
            array: name of the array in a .npz.
            kind: the nearest value, or linear between (means over finer cells).

        Raises:
            CaseError: there is no such file, or it says nothing on the terrain.
            TerrainError: the file is not valid.
        """
        raster = read_dem(
            self.file(table, key),
            key=array,
            row0=table.choice("row0", ("south", "north"), "south"),
            cell_size=self.grid.dx,
            origin=(self.grid.x0, self.grid.y0),
        )
        self.check_system(table, key, raster)
        grid = self.grid
        finer = grid.dx > 1.5 * raster.dx
        chosen: Literal["nearest", "linear", "average"] = "average" if finer and kind == "linear" else kind
        values = sample(raster, grid.x0, grid.y0, grid.dx, grid.nrows, grid.ncols, chosen).astype(np.float32)
        if np.isnan(values).all():
            theirs, ours = ([round(edge, 3) for edge in box] for box in (raster.bounds, grid.extent))
            raise table.wrong(
                key,
                f"it covers (xmin, ymin, xmax, ymax) {theirs} m and says nothing on the terrain"
                f" {ours} m; a raster with values there is allowed",
            )
        return values

    def check_system(self, table: Table, key: str, raster: Raster) -> None:
        """Refuse a raster in another coordinate system than the terrain's.

        Raises:
            TerrainError: it is.
        """
        said_by = f"{table.file}: {table.label} {key}"
        if raster.crs is not None and not same_crs(self.grid.crs, raster.crs, said_by):
            raise TerrainError(
                f"{said_by} '{table.text(key)}' is not in '{self.grid.crs}', the system of the terrain."
            )

    def covered(self, table: Table) -> NDArray[np.bool_]:
        """Cells whose centres lie in the area of a table.

        Raises:
            CaseError: there is no area, or it holds no cell.
        """
        return covered_cells(table, self.folder, self.grid)


def read_area(table: Table, folder: CaseFolder) -> list[list[Ring]]:
    """Polygons given in place (`polygon`) or by a file (`polygons`).

    Raises:
        CaseError: both or none are given, or one is not valid.
    """
    if table.has("polygon") == table.has("polygons"):
        raise table.wrong("polygons", "either 'polygons' (a file) or 'polygon' (points) is needed")
    if table.has("polygons"):
        return read_polygons(folder.find(table.text("polygons"), f"{table.file}: {table.label} polygons"))
    try:
        return [[check_ring(table.points("polygon", 3))]]
    except ValueError as error:
        raise table.wrong("polygon", str(error)) from error


def covered_cells(table: Table, folder: CaseFolder, grid: GridGeometry) -> NDArray[np.bool_]:
    """Cells whose centres lie in the area of a table [nrows, ncols].

    Raises:
        CaseError: there is no area, or it holds no cell.
    """
    inside = cells_inside(read_area(table, folder), grid)
    if not inside.any():
        xmin, ymin, xmax, ymax = grid.extent
        raise CaseError(
            f"{table.file}: {table.label} covers no cell of the terrain; polygons around at least one cell"
            f" centre within x {xmin:.10g} to {xmax:.10g} and y {ymin:.10g} to {ymax:.10g} m are allowed."
        )
    return inside
