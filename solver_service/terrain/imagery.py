"""Pictures of the terrain: a case's imagery on the extent of its grid, and its cells without data."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from protocol import GridGeometry
from protocol.limits import MAX_IMAGERY_BYTES, MAX_IMAGERY_SIDE
from solver_service.errors import TerrainError
from solver_service.terrain.projection import LOCAL

__all__ = ["MAX_SOURCE_PIXELS", "imagery_picture", "walls_picture"]

MAX_SOURCE_PIXELS = 1 << 29
"""Largest picture that is read."""

_DRIVERS = {
    b"II*\0": "GTiff",
    b"MM\0*": "GTiff",
    b"II+\0": "GTiff",
    b"MM\0+": "GTiff",
    b"\x89PNG\r\n\x1a\n": "PNG",
    b"\xff\xd8\xff": "JPEG",
}
"""GDAL opens nearly anything, so the first bytes choose one driver."""
_QUALITY = 88
_NO_IMAGE = 128
"""Grey of what a georeferenced picture does not cover."""


def imagery_picture(path: Path, grid: GridGeometry) -> bytes:
    """A picture of the ground, resampled to the extent of a grid, as a JPEG.

    A GeoTIFF is laid where it says that it lies, whatever its coordinate system; a picture that says nothing
    (PNG, JPEG, plain TIFF) is taken to cover the grid. The result is as fine as the source, up to
    MAX_IMAGERY_SIDE.

    Args:
        path: GeoTIFF, PNG or JPEG of 8 bits: grey, or red, green and blue (and alpha, which is ignored).
        grid: what it is to cover.

    Raises:
        TerrainError: the file is none of these, is too large, or lies elsewhere.
    """
    import rasterio
    from rasterio.errors import NotGeoreferencedWarning, RasterioError

    quiet = {"GDAL_DISABLE_READDIR_ON_OPEN": "EMPTY_DIR", "GDAL_PAM_ENABLED": "NO"}
    try:
        with (
            warnings.catch_warnings(action="ignore", category=NotGeoreferencedWarning),
            rasterio.Env(**quiet),
            rasterio.open(path.resolve(), driver=_driver(path)) as source,
        ):
            _check(path, source)
            colours = _laid(path, source, grid)
            return _packed(colours, "JPEG", quality=_QUALITY)
    except (RasterioError, OSError, ValueError) as error:
        raise TerrainError(f"Picture '{path.name}' cannot be read: {error}.") from error


def walls_picture(wall: NDArray[np.bool_]) -> bytes:
    """Cells without data as a greyscale PNG, 255 where there is none.

    Args:
        wall: shape [nrows, ncols], row 0 in the south.
    """
    return _packed(np.where(wall[::-1], np.uint8(255), np.uint8(0))[None], "PNG", zlevel=6)


def _driver(path: Path) -> str:
    with path.open("rb") as file:
        head = file.read(16)
    driver = next((driver for magic, driver in _DRIVERS.items() if head.startswith(magic)), None)
    if driver is None:
        raise TerrainError(
            f"Picture '{path.name}' does not begin like a TIFF, PNG or JPEG; these are allowed as imagery."
        )
    return driver


def _check(path: Path, source: Any) -> None:
    width, height, count = source.width, source.height, source.count
    if width * height > MAX_SOURCE_PIXELS:
        raise TerrainError(
            f"Picture '{path.name}' has {height} x {width} pixels; up to {MAX_SOURCE_PIXELS} are allowed."
        )
    types = set(source.dtypes)
    if count not in (1, 3, 4) or types != {"uint8"}:
        raise TerrainError(
            f"Picture '{path.name}' has {count} bands of {' and '.join(sorted(types))};"
            " 1, 3 or 4 bands of uint8 are allowed."
        )


def _laid(path: Path, source: Any, grid: GridGeometry) -> NDArray[np.uint8]:
    """Three bands over the extent of the grid, row 0 in the north."""
    from rasterio.crs import CRS
    from rasterio.enums import Resampling
    from rasterio.transform import from_bounds
    from rasterio.vrt import WarpedVRT

    bands = [1, 1, 1] if source.count == 1 else [1, 2, 3]
    xmin, ymin, xmax, ymax = grid.extent
    if source.transform.is_identity:
        width, height = _size(source.width, source.height)
        out: NDArray[np.uint8] = source.read(
            bands, out_shape=(3, height, width), resampling=Resampling.average
        )
        return out
    target = CRS.from_user_input(grid.crs) if grid.crs != LOCAL else source.crs
    own = source.crs or target
    with WarpedVRT(source, src_crs=own, crs=target or own, resampling=Resampling.bilinear) as native:
        pixel = max(native.res)
        bounds = native.bounds
    if bounds.right <= xmin or bounds.left >= xmax or bounds.top <= ymin or bounds.bottom >= ymax:
        raise TerrainError(
            f"Picture '{path.name}' covers x {bounds.left:g} to {bounds.right:g} and y {bounds.bottom:g} to"
            f" {bounds.top:g}, nothing of the terrain."
        )
    width, height = _size((xmax - xmin) / pixel, (ymax - ymin) / pixel)
    with WarpedVRT(
        source,
        src_crs=own,
        crs=target or own,
        transform=from_bounds(xmin, ymin, xmax, ymax, width, height),
        width=width,
        height=height,
        resampling=Resampling.average,
        add_alpha=source.count != 4,
    ) as laid:
        colours: NDArray[np.uint8] = laid.read(bands)
        colours[:, laid.read(laid.count) == 0] = _NO_IMAGE
        return colours


def _size(width: float, height: float) -> tuple[int, int]:
    """Pixels of the result: those of the source, fewer where a side would pass the limit."""
    scale = min(1.0, MAX_IMAGERY_SIDE / max(width, height))
    return max(1, min(MAX_IMAGERY_SIDE, round(width * scale))), max(
        1, min(MAX_IMAGERY_SIDE, round(height * scale))
    )


def _packed(bands: NDArray[np.uint8], driver: str, **options: int) -> bytes:
    from rasterio.io import MemoryFile

    shape = {"count": bands.shape[0], "height": bands.shape[1], "width": bands.shape[2]}
    with warnings.catch_warnings(action="ignore"), MemoryFile() as memory:
        with memory.open(driver=driver, dtype="uint8", **shape, **options) as picture:
            picture.write(bands)
        packed = bytes(memory.read())
    if len(packed) > MAX_IMAGERY_BYTES:
        raise TerrainError(f"A picture of {len(packed)} bytes is too large; {MAX_IMAGERY_BYTES} are allowed.")
    return packed
