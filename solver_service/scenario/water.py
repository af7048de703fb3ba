"""Where the water is at time 0, and where it comes from: [initial], [[boundary]], [[source]], [rain]."""

from __future__ import annotations

import math
from datetime import datetime
from typing import cast

import numpy as np
from numpy.typing import NDArray

from solver_service.errors import CaseError
from solver_service.numerics import EdgeBoundary, Rain, Source
from solver_service.numerics.model import EDGES, Edge
from solver_service.scenario.case_folder import CaseFolder
from solver_service.scenario.ground import read_on_grid
from solver_service.scenario.keys import BOUNDARY_KINDS, BOUNDARY_KINDS_NOT_YET
from solver_service.scenario.series import read_series
from solver_service.scenario.table import Table
from solver_service.terrain import Terrain, cells_inside, check_ring

MM_PER_HOUR = 1e-3 / 3600.0
"""[m/s]"""


def read_initial(table: Table, folder: CaseFolder, terrain: Terrain) -> NDArray[np.float32]:
    """Depth at time 0 [m]: a raster, then levels, each in its part where it is higher than what is there.

    Raises:
        CaseError: a depth is negative, or a key is not valid.
    """
    grid = terrain.grid
    h = np.zeros(grid.shape, np.float32)
    key, row0 = table.text("depth_key", "depth"), table.choice("row0", ("south", "north"), "south")
    if table.has("depth"):
        path = folder.find(table.text("depth"), f"{table.file}: [initial] depth")
        h = np.nan_to_num(read_on_grid(path, table, grid, key, row0, "linear"), nan=0.0)
        if (h < 0.0).any():
            row, col = np.argwhere(h < 0.0)[0].tolist()
            raise CaseError(
                f"{table.file}: [initial] depth '{table.text('depth')}' is {h[row, col]:g} m in cell"
                f" (row {row}, column {col}); a depth at or above 0 m is allowed."
            )
    for level in table.tables("level"):
        h = np.maximum(h, _pool(level, terrain))
    h[terrain.wall] = 0.0
    return h


def _pool(table: Table, terrain: Terrain) -> NDArray[np.float32]:
    grid = terrain.grid
    eta = table.real("level", "an elevation in m", -20_000.0, 20_000.0) - grid.datum_offset
    depth: NDArray[np.float32] = np.maximum(np.float32(eta) - terrain.z_b, np.float32(0.0))
    ways = [key for key in ("polygon", "side_of_line", "everywhere_below") if table.has(key)]
    if len(ways) != 1:
        raise CaseError(
            f"{table.file}: [[initial.level]] number {table.number} has"
            f" {' and '.join(ways) or 'no place'}; one of polygon, side_of_line, everywhere_below is allowed."
        )
    if ways == ["polygon"]:
        try:
            ring = check_ring(table.points("polygon", 3))
        except ValueError as error:
            raise table.wrong("polygon", str(error)) from error
        depth[~cells_inside([[ring]], grid)] = 0.0
    elif ways == ["side_of_line"]:
        (xa, ya), (xb, yb) = table.points("side_of_line", 2, 2)
        if (xa, ya) == (xb, yb):
            raise table.wrong("side_of_line", "two different points are allowed")
        x = grid.x0 + (np.arange(grid.ncols) + 0.5) * grid.dx
        y = grid.y0 + (np.arange(grid.nrows) + 0.5) * grid.dx
        left = (xb - xa) * (y[:, None] - ya) - (yb - ya) * (x[None, :] - xa) > 0.0
        depth[~left] = 0.0
    elif not table.flag("everywhere_below"):
        raise table.wrong("everywhere_below", "true is allowed, or leave it out")
    depth[terrain.wall] = 0.0
    if table.has("connected_to"):
        depth[~_connected(table, depth > 0.0, terrain)] = 0.0
    return depth


def _connected(table: Table, wet: NDArray[np.bool_], terrain: Terrain) -> NDArray[np.bool_]:
    from scipy import ndimage

    row, col = cell_of(table, "connected_to", terrain)
    pools, _ = ndimage.label(wet)
    if pools[row, col] == 0:
        raise table.wrong("connected_to", "a point that is under water at this level is allowed")
    same: NDArray[np.bool_] = pools == pools[row, col]
    return same


def cell_of(table: Table, key: str, terrain: Terrain) -> tuple[int, int]:
    """Row and column of the cell that holds a point of the case.

    Raises:
        CaseError: the point lies outside the terrain.
    """
    x, y = table.point(key)
    grid = terrain.grid
    if not grid.contains(x, y):
        xmin, ymin, xmax, ymax = grid.extent
        raise table.wrong(
            key, f"a point within x {xmin:g} to {xmax:g} and y {ymin:g} to {ymax:g} m is allowed"
        )
    row, col = grid.to_cell(x, y)
    return min(round(row), grid.nrows - 1), min(round(col), grid.ncols - 1)


def read_boundaries(tables: list[Table], terrain: Terrain) -> tuple[EdgeBoundary, ...]:
    """Edge segments; where nothing is said stands a wall.

    Raises:
        CaseError: a kind is unknown or not supported, or a segment lies off its edge.
    """
    grid = terrain.grid
    boundaries = []
    for table in tables:
        edge = cast(Edge, table.choice("edge", EDGES))
        kind = table.values.get("kind", "wall")
        if kind in BOUNDARY_KINDS_NOT_YET:
            raise table.wrong(
                "kind",
                f"this version computes {' and '.join(BOUNDARY_KINDS)} edges, and [[source]] for inflow",
            )
        table.choice("kind", BOUNDARY_KINDS, "wall")
        along_y = edge in ("west", "east")
        start, count = (grid.y0, grid.nrows) if along_y else (grid.x0, grid.ncols)
        stop = start + count * grid.dx
        span = f"a coordinate in m along the edge, {start:g} to {stop:g},"
        low = table.real("from", span, start, stop, default=start)
        high = table.real("to", span, start, stop, default=stop)
        first = max(0, round((low - start) / grid.dx))
        last = min(count, round((high - start) / grid.dx))
        if last <= first:
            raise table.wrong("to", f"a segment of at least one cell ({grid.dx:g} m) is allowed")
        boundaries.append(EdgeBoundary(edge, "open" if kind == "open" else "wall", first, last))
    return tuple(boundaries)


def read_sources(
    tables: list[Table], folder: CaseFolder, terrain: Terrain, start_time: datetime | None
) -> tuple[Source, ...]:
    """Inflows into discs of cells.

    Raises:
        CaseError: a source lies outside the terrain or on a wall, or its discharge is not valid.
    """
    grid = terrain.grid
    sources = []
    for table in tables:
        row, col = cell_of(table, "at", terrain)
        radius = table.real("radius", "a radius in m at or above 0", 0.0, 1e6, default=0.0)
        x, y = table.point("at")
        if table.has("discharge") == table.has("series"):
            raise table.wrong("discharge", "either 'discharge' in m3/s or 'series' (a CSV file) is needed")
        if table.has("series"):
            path = folder.find(table.text("series"), f"{table.file}: [[source]] series")
            series = read_series(path, start_time)
            times, discharge = series.times, series.values
        else:
            constant = table.real("discharge", "a discharge in m3/s at or above 0", 0.0, 1e9)
            times, discharge = np.array([0.0]), np.array([constant])
        reach = math.ceil(radius / grid.dx)
        rows = np.arange(max(0, row - reach), min(grid.nrows, row + reach + 1))
        cols = np.arange(max(0, col - reach), min(grid.ncols, col + reach + 1))
        dy = grid.y0 + (rows[:, None] + 0.5) * grid.dx - y
        dx = grid.x0 + (cols[None, :] + 0.5) * grid.dx - x
        within = (dx * dx + dy * dy <= radius * radius) | ((rows[:, None] == row) & (cols[None, :] == col))
        within &= ~terrain.wall[np.ix_(rows, cols)]
        if not within.any():
            raise table.wrong("at", "a place with terrain data is allowed")
        found_rows, found_cols = np.nonzero(within)
        sources.append(
            Source(rows[found_rows].astype(np.int32), cols[found_cols].astype(np.int32), times, discharge)
        )
    return tuple(sources)


def read_rain(
    table: Table | None, folder: CaseFolder, shape: tuple[int, int], start_time: datetime | None
) -> Rain | None:
    """Rain on every cell of a grid of that shape; None without rain.

    Raises:
        CaseError: the series is not valid, or a raster series is asked for.
    """
    if table is None:
        return None
    if table.has("rate") == table.has("series"):
        raise table.wrong("series", "either 'series' (a CSV file) or 'rate' in mm/h is needed")
    if table.has("rate"):
        rate = table.real("rate", "a rain rate in mm/h from 0 to 10000", 0.0, 1e4)
        return Rain.uniform(0.0, rate * MM_PER_HOUR, shape)
    name = table.text("series")
    if not name.lower().endswith(".csv"):
        raise table.wrong(
            "series", "this version computes rain that is the same everywhere, from a .csv of mm/h;"
        )
    series = read_series(folder.find(name, f"{table.file}: [rain] series"), start_time)
    return Rain.uniform(series.times, series.values * MM_PER_HOUR, shape)
