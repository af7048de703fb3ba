"""A raster as it stands in a file, turned once so that row 0 is the southern edge."""

from __future__ import annotations

import lzma
import math
import struct
import zipfile
import zlib
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from protocol.limits import MAX_CELLS
from solver_service.errors import TerrainError

BROKEN_ARCHIVE = (
    OSError,
    EOFError,
    MemoryError,
    RuntimeError,
    ValueError,
    lzma.LZMAError,
    struct.error,
    zipfile.BadZipFile,
    zlib.error,
)
"""What reading a damaged zip or gzip archive may raise."""

NO_DATA_BEYOND = 1e30
"""Values of this size or larger [m] mean no data, whatever the file says of its NoData value."""


@dataclass(frozen=True)
class Raster:
    """Values on cells of dx by dy, in the coordinates of the file.

    Attributes:
        values: float32 or float64 [nrows, ncols], row 0 is the southern edge, NaN where there is no data.
        x0: x of the south-western corner [m or degrees].
        y0: y of the south-western corner [m or degrees].
        dx: cell size along x [m or degrees].
        dy: cell size along y [m or degrees].
        crs: coordinate system as PROJ reads it; None where the file names none.
    """

    values: NDArray[np.floating]
    x0: float
    y0: float
    dx: float
    dy: float
    crs: str | None = None

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        rows, cols = self.values.shape
        return (rows, cols)

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """Outer edges (xmin, ymin, xmax, ymax)."""
        rows, cols = self.shape
        return (self.x0, self.y0, self.x0 + cols * self.dx, self.y0 + rows * self.dy)

    @property
    def void(self) -> NDArray[np.bool_]:
        """Cells without data."""
        void: NDArray[np.bool_] = np.isnan(self.values)
        return void


def one_mask(values: NDArray[np.generic], nodata: float | None) -> NDArray[np.floating]:
    """Floating-point copy with NaN for NoData, NaN, infinities and absurd values alike.

    Args:
        values: numbers as they were read.
        nodata: value that means no data, None where the file names none.
    """
    kind = (
        np.float64
        if values.dtype.itemsize > 4 or (values.dtype.kind in "iu" and values.dtype.itemsize > 2)
        else np.float32
    )
    out: NDArray[np.floating] = values.astype(kind)
    with np.errstate(invalid="ignore"):
        void = ~np.isfinite(out) | (np.abs(out) >= NO_DATA_BEYOND)
        if nodata is not None:
            void |= values == nodata
    out[void] = np.nan
    return out


def check_size(path: Path, nrows: int, ncols: int) -> None:
    """Refuse a raster that is too large before its numbers are read.

    Raises:
        TerrainError: naming the file and the limit.
    """
    if nrows < 1 or ncols < 1 or nrows * ncols > MAX_CELLS:
        raise TerrainError(
            f"Raster '{path.name}' has {nrows} x {ncols} cells; 1 to {MAX_CELLS} cells are allowed."
        )


def crop(raster: Raster, bounds: tuple[float, float, float, float], name: str) -> Raster:
    """The cells whose centres lie within bounds.

    Args:
        raster: the raster.
        bounds: xmin, ymin, xmax, ymax in its coordinates.
        name: file name for the error.

    Raises:
        TerrainError: no cell lies within the bounds.
    """
    rows, cols = raster.shape
    col0 = max(0, math.ceil((bounds[0] - raster.x0) / raster.dx - 0.5 - 1e-6))
    row0 = max(0, math.ceil((bounds[1] - raster.y0) / raster.dy - 0.5 - 1e-6))
    col1 = min(cols, math.ceil((bounds[2] - raster.x0) / raster.dx - 0.5 - 1e-6))
    row1 = min(rows, math.ceil((bounds[3] - raster.y0) / raster.dy - 0.5 - 1e-6))
    if col1 <= col0 or row1 <= row0:
        raise TerrainError(
            f"[terrain] bounds = {list(bounds)} hold no cell of '{name}';"
            f" its edges (xmin, ymin, xmax, ymax) are {[round(edge, 3) for edge in raster.bounds]}."
        )
    x0, y0 = raster.x0 + col0 * raster.dx, raster.y0 + row0 * raster.dy
    return Raster(raster.values[row0:row1, col0:col1], x0, y0, raster.dx, raster.dy, raster.crs)
