"""[initial] and [[initial.level]]: where the water is at time 0."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from solver_service.errors import CaseError
from solver_service.scenario.inputs import Inputs
from solver_service.scenario.quantities import LEVEL
from solver_service.scenario.table import Table

FAR_ABOVE = 1000.0
"""Water this much higher than all ground [m] is refused."""
PLACES = ("polygon", "polygons", "side_of_line", "everywhere_below")


def read_initial(table: Table, inputs: Inputs) -> NDArray[np.float32]:
    """Depth at time 0 [m]: the largest of a raster of depths, one of levels, and the levels in their parts.

    Raises:
        CaseError: a depth is negative, a level absurd, or a key is not valid.
        TerrainError: a raster is not valid.
    """
    table.only_beside("depth_key", "depth")
    table.only_beside("surface_key", "surface")
    table.only_beside("row0", "depth", "surface")
    h = np.zeros(inputs.grid.shape, np.float32)
    if table.has("depth"):
        values = inputs.raster(table, "depth", table.text("depth_key", "depth"), "linear")
        h = np.nan_to_num(values, nan=0.0)
        if (h < 0.0).any():
            row, col = np.argwhere(h < 0.0)[0].tolist()
            raise CaseError(
                f"{table.file}: [initial] depth '{table.text('depth')}' is {h[row, col]:g} m in cell"
                f" (row {row}, column {col}); a depth at or above 0 m is allowed."
            )
        _check_height(table, "depth", float(h.max()))
    if table.has("surface"):
        values = inputs.raster(table, "surface", table.text("surface_key", "surface"), "linear")
        above = values.astype(np.float64) - inputs.grid.datum_offset - inputs.terrain.z_b
        depth = np.maximum(np.nan_to_num(above, nan=0.0), 0.0).astype(np.float32)
        _check_height(table, "surface", float(depth.max()))
        h = np.maximum(h, depth)
    for level in table.tables("level"):
        h = np.maximum(h, _pool(level, inputs))
    h[inputs.terrain.wall] = 0.0
    return h


def _check_height(table: Table, key: str, depth: float) -> None:
    if depth > FAR_ABOVE:
        raise table.wrong(
            key,
            f"it puts {depth:g} m of water on the ground; up to {FAR_ABOVE:g} m is allowed, so check units",
        )


def check_level(table: Table, key: str, level: float, inputs: Inputs) -> None:
    """Refuse a water level [m] far above all ground of the terrain.

    Raises:
        CaseError: it is.
    """
    highest = float(inputs.terrain.z_b[~inputs.terrain.wall].max()) + inputs.grid.datum_offset
    if level > highest + FAR_ABOVE:
        raise table.wrong(
            key,
            f"the highest ground is at {highest:.2f} m; a level up to {FAR_ABOVE:g} m above is allowed, so"
            " check unit and vertical datum",
        )


def _pool(table: Table, inputs: Inputs) -> NDArray[np.float32]:
    terrain = inputs.terrain
    if table.has("level") == table.has("depth"):
        raise table.wrong("level", "either 'level' (an elevation in m) or 'depth' in m is needed")
    if table.has("depth"):
        depth = np.full(
            inputs.grid.shape, table.real("depth", "a depth in m from 0 to 1000", 0.0, FAR_ABOVE), np.float32
        )
    else:
        level = table.real("level", "an elevation in m", LEVEL.low, LEVEL.high)
        check_level(table, "level", level, inputs)
        eta = np.float32(level - inputs.grid.datum_offset)
        depth = np.maximum(eta - terrain.z_b, np.float32(0.0))
    ways = [key for key in PLACES if table.has(key)]
    if len(ways) != 1:
        raise CaseError(
            f"{table.file}: [[initial.level]] number {table.number} has"
            f" {' and '.join(ways) or 'no place'}; one of {', '.join(PLACES)} is allowed."
        )
    if ways[0] in ("polygon", "polygons"):
        depth[~inputs.covered(table)] = 0.0
    elif ways == ["side_of_line"]:
        depth[~_left_of_line(table, inputs)] = 0.0
    elif not table.flag("everywhere_below"):
        raise table.wrong("everywhere_below", "true is allowed, or leave it out")
    depth[terrain.wall] = 0.0
    if table.has("connected_to"):
        depth[~_connected(table, depth > 0.0, inputs)] = 0.0
    return depth


def _left_of_line(table: Table, inputs: Inputs) -> NDArray[np.bool_]:
    (xa, ya), (xb, yb) = table.points("side_of_line", 2, 2)
    if (xa, ya) == (xb, yb):
        raise table.wrong("side_of_line", "two different points are allowed")
    grid = inputs.grid
    x = grid.x0 + (np.arange(grid.ncols) + 0.5) * grid.dx
    y = grid.y0 + (np.arange(grid.nrows) + 0.5) * grid.dx
    left: NDArray[np.bool_] = (xb - xa) * (y[:, None] - ya) - (yb - ya) * (x[None, :] - xa) > 0.0
    return left


def _connected(table: Table, wet: NDArray[np.bool_], inputs: Inputs) -> NDArray[np.bool_]:
    from scipy import ndimage

    row, col = inputs.cell(table, "connected_to")
    pools, _ = ndimage.label(wet)
    if pools[row, col] == 0:
        raise table.wrong("connected_to", "a point that is under water at this level is allowed")
    same: NDArray[np.bool_] = pools == pools[row, col]
    return same
