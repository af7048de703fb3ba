"""Coordinate systems: metres are demanded, degrees are refused with the zone to use, or reprojected."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from protocol.limits import MAX_CELLS
from solver_service.errors import TerrainError
from solver_service.terrain.raster import Raster

LOCAL = "local"
"""Name of a coordinate system that is none: metres from some corner of a laboratory."""


def read_crs(text: str, where: str) -> Any:
    """A `pyproj.CRS`.

    Raises:
        TerrainError: PROJ does not know it.
    """
    from pyproj import CRS
    from pyproj.exceptions import CRSError

    try:
        return CRS.from_user_input(text)
    except CRSError as error:
        raise TerrainError(
            f"{where} '{_short(text)}' is no coordinate system that PROJ knows; an EPSG code like"
            f" 'EPSG:32632', or '{LOCAL}', is allowed."
        ) from error


def check_metres(text: str, where: str, centre: tuple[float, float] | None = None) -> None:
    """Refuse a coordinate system that is not projected in metres.

    Args:
        text: the coordinate system, or "local".
        where: what names it, to begin the error with.
        centre: longitude and latitude of the data, to name a UTM zone with.

    Raises:
        TerrainError: it is in degrees or in another unit.
    """
    if text == LOCAL:
        return
    crs = read_crs(text, where)
    if crs.is_geographic:
        zone = f", for these data {utm_zone(*centre)}" if centre else ""
        raise TerrainError(
            f"{where} '{_short(text, crs)}' is in degrees; a projected system in metres is allowed{zone}:"
            " name it in [terrain] reproject, or reproject the file."
        )
    units = {axis.unit_name for axis in crs.axis_info[:2]}
    if not crs.is_projected or not all(
        math.isclose(axis.unit_conversion_factor, 1.0) for axis in crs.axis_info[:2]
    ):
        raise TerrainError(
            f"{where} '{_short(text, crs)}' is in {' and '.join(sorted(units))}; metres are allowed."
        )


def is_geographic(text: str | None, where: str) -> bool:
    """Whether a coordinate system is in degrees."""
    return text is not None and text != LOCAL and bool(read_crs(text, where).is_geographic)


def same_crs(first: str, second: str, where: str) -> bool:
    """Whether two names mean the same horizontal system."""
    if first == second:
        return True
    if LOCAL in (first, second):
        return False
    a, b = read_crs(first, where), read_crs(second, where)
    return bool(a.equals(b, ignore_axis_order=True)) or (
        a.to_epsg() is not None and a.to_epsg() == b.to_epsg()
    )


def utm_zone(longitude: float, latitude: float) -> str:
    """The UTM zone of a place, with its EPSG code."""
    zone = min(60, int((longitude + 180.0) // 6.0) + 1)
    south = latitude < 0.0
    return f"UTM zone {zone}{'S' if south else 'N'}, EPSG:{(32700 if south else 32600) + zone}"


def centre_of(raster: Raster) -> tuple[float, float]:
    """Middle of a raster in its own coordinates."""
    xmin, ymin, xmax, ymax = raster.bounds
    return (0.5 * (xmin + xmax), 0.5 * (ymin + ymax))


def reproject(raster: Raster, target: str, cell_size: float | None, where: str) -> Raster:
    """Cubic resampling to another coordinate system; NaN outside the source and beside its holes.

    Args:
        raster: the source, which names its coordinate system.
        target: a projected system in metres.
        cell_size: cell size of the result [m]; None keeps that of the source.
        where: what names the target, to begin the error with.

    Raises:
        TerrainError: the target is not in metres, or PROJ cannot get there.
    """
    import rasterio
    from rasterio.errors import RasterioError
    from rasterio.transform import from_origin
    from rasterio.warp import Resampling, calculate_default_transform, reproject

    check_metres(target, where)
    source_crs = rasterio.crs.CRS.from_user_input(raster.crs)
    target_crs = rasterio.crs.CRS.from_user_input(target)
    rows, cols = raster.shape
    source_transform = from_origin(raster.x0, raster.bounds[3], raster.dx, raster.dy)
    try:
        turn, width, height = calculate_default_transform(
            source_crs, target_crs, cols, rows, *raster.bounds, resolution=cell_size
        )
        dx = cell_size or _round_cell(turn.a)
        west, north = math.floor(turn.c / dx) * dx, math.ceil(turn.f / dx) * dx
        width, height = math.ceil(width * turn.a / dx) + 1, math.ceil(-height * turn.e / dx) + 1
        if width * height > MAX_CELLS:
            raise TerrainError(
                f"{where} '{target}' takes {height} x {width} cells; up to {MAX_CELLS} are allowed."
            )
        out = np.full((height, width), np.nan, np.float32)
        reproject(
            np.ascontiguousarray(raster.values[::-1], dtype=np.float32),
            out,
            src_transform=source_transform,
            src_crs=source_crs,
            src_nodata=np.nan,
            dst_transform=from_origin(west, north, dx, dx),
            dst_crs=target_crs,
            dst_nodata=np.nan,
            resampling=Resampling.cubic,
        )
    except (RasterioError, ValueError) as error:
        raise TerrainError(f"{where} '{target}' cannot be reached: {error}.") from error
    held = np.argwhere(~np.isnan(out))
    if held.size == 0:
        raise TerrainError(f"{where} '{target}' holds nothing of the terrain.")
    (row0, col0), (row1, col1) = held.min(axis=0), held.max(axis=0) + 1
    bottom = north - row1 * dx
    return Raster(
        np.ascontiguousarray(out[row0:row1, col0:col1][::-1]), west + col0 * dx, bottom, dx, dx, target
    )


def _round_cell(size: float) -> float:
    """Two significant digits are enough for a cell size nobody asked for."""
    digits = 1 - math.floor(math.log10(size))
    return round(size, digits)


def _short(text: str, crs: Any = None) -> str:
    if crs is not None and crs.to_epsg():
        return f"EPSG:{crs.to_epsg()}"
    return text if len(text) <= 60 else text[:57] + "..."
