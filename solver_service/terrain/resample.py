"""From the cells of one raster to the cells of another, each axis by a matrix of weights.

out = (W_y v W_x^T) / (W_y m W_x^T) with v = 0 and m = 0 where there is no data: holes stay out of every mean.
The weights of an axis are the shares of overlap (average), the two neighbours (linear), or the four of the
Catmull-Rom cubic (Keys 1981, a = -1/2).
"""

from __future__ import annotations

import math
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from solver_service.terrain.raster import Raster

Kind = Literal["average", "linear", "cubic", "nearest"]


def resample(raster: Raster, cell_size: float) -> Raster:
    """The same area on square cells of another size: means when coarser, cubic when finer.

    Args:
        raster: the source.
        cell_size: new cell size [m].
    """
    if math.isclose(raster.dx, cell_size, rel_tol=1e-6) and math.isclose(raster.dy, cell_size, rel_tol=1e-6):
        return raster
    xmin, ymin, xmax, ymax = raster.bounds
    ncols = max(1, math.floor((xmax - xmin) / cell_size + 1e-6))
    nrows = max(1, math.floor((ymax - ymin) / cell_size + 1e-6))
    kind: Kind = "average" if cell_size > max(raster.dx, raster.dy) else "cubic"
    values = sample(raster, xmin, ymin, cell_size, nrows, ncols, kind)
    return Raster(values, xmin, ymin, cell_size, cell_size, raster.crs)


def sample(
    raster: Raster, x0: float, y0: float, dx: float, nrows: int, ncols: int, kind: Kind
) -> NDArray[np.floating]:
    """Values on given cells; NaN where the nearest source cell has no data or lies outside.

    Args:
        raster: the source.
        x0: x of the south-western corner of the cells [m].
        y0: y of their south-western corner [m].
        dx: their size [m].
        nrows: rows.
        ncols: columns.
        kind: how.
    """
    rows, cols = raster.shape
    near_row = np.floor((y0 + (np.arange(nrows) + 0.5) * dx - raster.y0) / raster.dy).astype(np.int64)
    near_col = np.floor((x0 + (np.arange(ncols) + 0.5) * dx - raster.x0) / raster.dx).astype(np.int64)
    outside = ((near_row < 0) | (near_row >= rows))[:, None] | ((near_col < 0) | (near_col >= cols))[None, :]
    nearest = raster.values[np.clip(near_row, 0, rows - 1)[:, None], np.clip(near_col, 0, cols - 1)[None, :]]
    nearest = np.where(outside, np.nan, nearest)
    if kind == "nearest":
        return nearest.astype(raster.values.dtype)
    along_y = axis_weights(rows, raster.y0, raster.dy, nrows, y0, dx, kind)
    along_x = axis_weights(cols, raster.x0, raster.dx, ncols, x0, dx, kind)
    data = ~raster.void
    weighted = along_y @ np.where(data, raster.values, 0.0) @ along_x.T
    share = along_y @ data.astype(np.float64) @ along_x.T
    if kind == "cubic" and not data.all():
        beside_hole = share < 1.0 - 1e-9
        weighted, share = np.where(beside_hole, nearest, weighted), np.where(beside_hole, 1.0, share)
    lost = np.isnan(nearest) if kind != "average" else share < 0.5 - 1e-9
    out = np.where(lost, np.nan, weighted / np.where(lost | (share <= 0.0), 1.0, share))
    return out.astype(raster.values.dtype)


def axis_weights(
    count: int, start: float, step: float, new_count: int, new_start: float, new_step: float, kind: Kind
) -> Any:
    """Sparse matrix [new_count, count] of weights along one axis; each row sums to 1 inside the source.

    Args:
        count: source cells.
        start: outer edge of the first source cell [m].
        step: source cell size [m].
        new_count: target cells.
        new_start: outer edge of the first target cell [m].
        new_step: target cell size [m].
        kind: average, linear or cubic.
    """
    from scipy.sparse import coo_array

    if kind == "average":
        low = (new_start + np.arange(new_count) * new_step - start) / step
        high = low + new_step / step
        reach = math.ceil(new_step / step) + 1
        taken = np.floor(low).astype(np.int64)[:, None] + np.arange(reach)[None, :]
        weight = np.minimum(high[:, None], taken + 1) - np.maximum(low[:, None], taken)
        weight = np.maximum(weight, 0.0) * step / new_step
        weight[(taken < 0) | (taken >= count)] = 0.0
    else:
        place = (new_start + (np.arange(new_count) + 0.5) * new_step - start) / step - 0.5
        base = np.floor(place).astype(np.int64)
        t = (place - base)[:, None]
        if kind == "linear":
            taken = base[:, None] + np.arange(2)[None, :]
            weight = np.hstack([1.0 - t, t])
        else:
            taken = base[:, None] + np.arange(-1, 3)[None, :]
            weight = 0.5 * np.hstack(
                [
                    -t + 2 * t**2 - t**3,
                    2 - 5 * t**2 + 3 * t**3,
                    t + 4 * t**2 - 3 * t**3,
                    -(t**2) + t**3,
                ]
            )
    target = np.broadcast_to(np.arange(new_count)[:, None], taken.shape)
    places = (target.ravel(), np.clip(taken, 0, count - 1).ravel())
    return coo_array((weight.ravel(), places), shape=(new_count, count)).tocsr()
