"""Maps as GeoTIFF: one band of float32, north up, NaN for no value."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from protocol import GridGeometry

LOCAL = "local"


def write_map(path: Path, values: NDArray[np.float32], grid: GridGeometry, unit: str, meaning: str) -> None:
    """Write one map.

    Args:
        path: the file.
        values: [nrows, ncols], row 0 in the south, NaN for no value.
        grid: where the cells are.
        unit: unit of the values.
        meaning: what they are, in a few words.

    Raises:
        OSError: the file cannot be written.
    """
    from rasterio.io import MemoryFile
    from rasterio.transform import from_origin

    xmin, _, _, ymax = grid.extent
    # GDAL only prints what fails while it closes a file on a full disk: so the file is made in memory.
    with MemoryFile() as memory:
        with memory.open(
            driver="GTiff",
            height=grid.nrows,
            width=grid.ncols,
            count=1,
            dtype="float32",
            nodata=float("nan"),
            crs=None if grid.crs == LOCAL else grid.crs,
            transform=from_origin(xmin, ymax, grid.dx, grid.dx),
            compress="deflate",
            predictor=3,
        ) as image:
            image.write(np.ascontiguousarray(values[::-1]), 1)
            image.units = (unit,)
            image.set_band_description(1, meaning)
        path.write_bytes(memory.getbuffer())
