"""NumPy archives (.npz): one array by its key, beside optional scalars x0, y0 and dx.

Compact forms are read too: an integer array `<key>` with the scalars `<key>_scale` and `<key>_offset` means
value = integer x scale + offset, with the smallest integer of its type for no data; and an array kept as
differences along both axes says so with the scalar `<key>_differences` = 1.
"""

from __future__ import annotations

import tokenize
import zipfile
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from protocol.limits import MAX_CELLS
from solver_service.errors import TerrainError
from solver_service.terrain.raster import BROKEN_ARCHIVE, Raster, check_size, one_mask


def read_npz(
    path: Path, key: str, row0: str, cell_size: float | None, origin: tuple[float, float] | None = None
) -> Raster:
    """Read one array of an archive.

    Args:
        path: the archive.
        key: name of the array.
        row0: "south" or "north": which edge row 0 of the array is.
        cell_size: cell size [m] where the archive holds no `dx`.
        origin: south-western corner [m] where the archive holds no `x0` and `y0`; None: (0, 0).

    Raises:
        TerrainError: not such an archive, or no such array in it, or no cell size anywhere.
    """
    try:
        with zipfile.ZipFile(path) as archive:
            sizes = {info.filename.removesuffix(".npy"): info.file_size for info in archive.infolist()}
        if sizes.get(key, 0) > 8 * MAX_CELLS + 4096:
            raise TerrainError(f"Array '{key}' of '{path.name}' is larger than {MAX_CELLS} cells.")
        if key not in sizes:
            raise TerrainError(
                f"Archive '{path.name}' has no array '{key}'; it has {', '.join(sorted(sizes)) or 'none'}."
            )
        with np.load(path, allow_pickle=False) as data:
            values = _unpack(data, key)
            scalars = {
                name: float(data[name])
                for name in ("x0", "y0", "dx")
                if name in data and data[name].size == 1
            }
    except (*BROKEN_ARCHIVE, KeyError, SyntaxError, tokenize.TokenError, TypeError) as error:
        raise TerrainError(f"File '{path.name}' cannot be read as a NumPy archive: {error}.") from error
    if values.ndim != 2:
        raise TerrainError(f"Array '{key}' of '{path.name}' has {values.ndim} dimensions; 2 are allowed.")
    check_size(path, *values.shape)
    dx = scalars.get("dx", cell_size)
    if dx is None:
        raise TerrainError(
            f"Archive '{path.name}' holds no cell size 'dx'; then [terrain] cell_size in m is needed."
        )
    west, south = origin or (0.0, 0.0)
    turned = values[::-1] if row0 == "north" else values
    return Raster(np.ascontiguousarray(turned), scalars.get("x0", west), scalars.get("y0", south), dx, dx)


def _unpack(data: np.lib.npyio.NpzFile, key: str) -> NDArray[np.floating]:
    stored = data[key]
    if stored.dtype.kind not in "iuf":
        raise TerrainError(f"Array '{key}' is of type {stored.dtype}; numbers are allowed.")
    if f"{key}_differences" in data:
        stored = np.cumsum(np.cumsum(stored, axis=0, dtype=stored.dtype), axis=1, dtype=stored.dtype)
    if f"{key}_scale" not in data:
        return one_mask(stored, None)
    offset = float(data[f"{key}_offset"]) if f"{key}_offset" in data else 0.0
    values = stored.astype(np.float64) * float(data[f"{key}_scale"]) + offset
    values[stored == np.iinfo(stored.dtype).min] = np.nan
    return one_mask(values, None)
