"""The ground a run stands on: square cells in metres, float32 from a datum offset, one mask of holes."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from protocol import GridGeometry
from solver_service.errors import TerrainError
from solver_service.terrain.raster import Raster

OFFSET_FROM = 256.0
"""Below this size [m] float32 keeps 1/32 of a millimetre, and elevations need no offset."""


@dataclass(frozen=True)
class Terrain:
    """Bed elevations that a solver can take.

    Attributes:
        grid: where the cells are; its datum_offset is what z_b is relative to.
        z_b: bed elevation [m, relative to the offset], float32 [nrows, ncols], finite everywhere.
        wall: cells without data that block the water.
        nodata_count: cells that had no data, walled or filled.
    """

    grid: GridGeometry
    z_b: NDArray[np.float32]
    wall: NDArray[np.bool_]
    nodata_count: int


def make_terrain(
    raster: Raster,
    *,
    name: str,
    crs: str,
    vertical_datum: str = "",
    nodata: Literal["wall", "fill"] = "wall",
    wall_level: float | None = None,
) -> Terrain:
    """Close the holes and choose the datum offset.

    Args:
        raster: elevations in metres on square cells.
        name: file name for errors.
        crs: name of the projected system.
        vertical_datum: what elevation 0 means.
        nodata: "wall" blocks the water there, "fill" interpolates the ground from around the hole.
        wall_level: elevation of walled cells [m]; None takes that of the nearest cell with data.

    Raises:
        TerrainError: the cells are not square, or none has data.
    """
    if not math.isclose(raster.dx, raster.dy, rel_tol=1e-4):
        raise TerrainError(
            f"Raster '{name}' has cells of {raster.dx:g} m by {raster.dy:g} m; square cells are allowed:"
            " give [terrain] cell_size."
        )
    void = raster.void
    if void.all():
        raise TerrainError(f"Raster '{name}' has no data in any of its {void.size} cells.")
    elevation = raster.values
    offset = datum_offset(float(np.nanmin(elevation)), float(np.nanmax(elevation)))
    z_b = (elevation - elevation.dtype.type(offset)).astype(np.float32)
    if void.any():
        z_b = _fill(z_b, void) if nodata == "fill" else _nearest(z_b, void)
        if nodata == "wall" and wall_level is not None:
            z_b[void] = wall_level - offset
    wall = void if nodata == "wall" else np.zeros_like(void)
    grid = GridGeometry(
        nrows=raster.shape[0],
        ncols=raster.shape[1],
        dx=raster.dx,
        x0=raster.x0,
        y0=raster.y0,
        crs=crs,
        vertical_datum=vertical_datum,
        datum_offset=offset,
    )
    return Terrain(grid, np.ascontiguousarray(z_b), wall, int(void.sum()))


def datum_offset(lowest: float, highest: float) -> float:
    """Elevation [m] that z_b is stored relative to: 0 near sea level, else the lowest ground by tens."""
    if max(abs(lowest), abs(highest)) < OFFSET_FROM:
        return 0.0
    return math.floor(lowest / 10.0) * 10.0


def _nearest(z_b: NDArray[np.float32], void: NDArray[np.bool_]) -> NDArray[np.float32]:
    from scipy import ndimage

    rows, cols = ndimage.distance_transform_edt(void, return_distances=False, return_indices=True)
    filled: NDArray[np.float32] = z_b[rows, cols]
    return filled


def _fill(z_b: NDArray[np.float32], void: NDArray[np.bool_]) -> NDArray[np.float32]:
    """Smooth ground across holes: the nearest cells first, then smoothed with their surroundings."""
    from scipy import ndimage

    filled = _nearest(z_b, void).astype(np.float64)
    for sigma in (8.0, 4.0, 2.0, 1.0, 1.0):
        filled[void] = ndimage.gaussian_filter(filled, sigma, mode="nearest")[void]
    return filled.astype(np.float32)
