"""GeoTIFF, USGS DEM and ERDAS Imagine rasters, read through GDAL.

GDAL opens nearly anything, a text file that makes it read other files included. So each format has one
driver, fixed by the first bytes of the file, and GDAL neither lists folders nor reads side-car files.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from pathlib import Path

from solver_service.errors import TerrainError
from solver_service.terrain.raster import Raster, check_size, one_mask

TIFF_MAGIC = (b"II*\0", b"MM\0*", b"II+\0", b"MM\0+")
METRES = ("", "m", "metre", "metres", "meter", "meters")


def read_geotiff(path: Path, band: int | None = None, units: Sequence[str] = METRES) -> Raster:
    """Read a GeoTIFF (cloud-optimised or not).

    Args:
        path: the file.
        band: which band, from 1; None where there is one.
        units: spellings of the unit that the file may name; "" for none.

    Raises:
        TerrainError: not a GeoTIFF with that band of real numbers on an upright grid.
    """
    if not _head(path).startswith(TIFF_MAGIC):
        raise TerrainError(f"File '{path.name}' does not begin like a TIFF; a GeoTIFF is allowed there.")
    return _read(path, "GTiff", band, units)


def read_usgs_dem(path: Path) -> Raster:
    """Read a USGS DEM in its ASCII form.

    Raises:
        TerrainError: not a USGS DEM.
    """
    return _read(path, "USGSDEM")


def read_erdas(path: Path) -> Raster:
    """Read an ERDAS Imagine raster.

    Raises:
        TerrainError: not an ERDAS Imagine raster.
    """
    if not _head(path).startswith(b"EHFA_HEADER_TAG"):
        raise TerrainError(f"File '{path.name}' does not begin like an ERDAS Imagine raster.")
    return _read(path, "HFA")


def _head(path: Path) -> bytes:
    try:
        with path.open("rb") as file:
            return file.read(256)
    except OSError as error:
        raise TerrainError(f"File '{path.name}' cannot be read: {error.strerror}.") from error


def _read(path: Path, driver: str, band: int | None = None, units: Sequence[str] = METRES) -> Raster:
    import rasterio
    from rasterio.errors import NotGeoreferencedWarning, RasterioError

    quiet = {"GDAL_DISABLE_READDIR_ON_OPEN": "EMPTY_DIR", "GDAL_PAM_ENABLED": "NO"}
    try:
        with (
            warnings.catch_warnings(action="ignore", category=NotGeoreferencedWarning),
            rasterio.Env(**quiet),
            rasterio.open(path.resolve(), driver=driver) as source,
        ):
            check_size(path, source.height, source.width)
            if band is None and source.count != 1:
                raise TerrainError(f"Raster '{path.name}' has {source.count} bands; one band is allowed.")
            number = 1 if band is None else band
            if not 1 <= number <= source.count:
                raise TerrainError(f"Raster '{path.name}' has {source.count} bands and no band {number}.")
            turn = source.transform
            if turn.b or turn.d or turn.a <= 0.0 or turn.e >= 0.0:
                raise TerrainError(
                    f"Raster '{path.name}' is turned or has no geographic position (transform"
                    f" {tuple(turn)[:6]}); rows that run from north to south are allowed."
                )
            unit = (source.units[number - 1] or "").strip().lower()
            if unit not in units:
                allowed = "metres are" if units is METRES else f"'{units[-1]}' is"
                raise TerrainError(f"Raster '{path.name}' has values in '{unit}'; {allowed} allowed.")
            if source.dtypes[number - 1].startswith("complex"):
                raise TerrainError(f"Raster '{path.name}' has complex values; real numbers are allowed.")
            values = one_mask(source.read(number), source.nodatavals[number - 1])[::-1]
            bottom = turn.f + source.height * turn.e
            crs = source.crs.to_wkt() if source.crs else None
            return Raster(values, turn.c, bottom, turn.a, -turn.e, crs)
    except (RasterioError, OSError, ValueError) as error:
        raise TerrainError(f"File '{path.name}' cannot be read as {driver}: {error}.") from error
