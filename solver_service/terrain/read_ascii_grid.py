"""ESRI ASCII grids: a header of names and numbers, then rows from north to south.

Read here and not by GDAL, which takes whole numbers for integers and then reads `nan`, and any other word,
as 0.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice
from pathlib import Path

import numpy as np

from solver_service.errors import TerrainError
from solver_service.terrain.raster import Raster, check_size, one_mask

NAMES = (
    "ncols",
    "nrows",
    "xllcorner",
    "yllcorner",
    "xllcenter",
    "yllcenter",
    "cellsize",
    "dx",
    "dy",
    "nodata_value",
)
NODATA = -9999.0
"""NoData value where the header names none."""
LINES = 256
"""Lines parsed at a time."""


def read_ascii_grid(path: Path) -> Raster:
    """Read an ESRI ASCII grid; its coordinate system stands in a .prj file beside it, if anywhere.

    Raises:
        TerrainError: not an ESRI ASCII grid, or not as many numbers as it says.
    """
    try:
        with path.open(encoding="ascii") as lines:
            header, first = _header(lines)
            ncols, nrows = (int(header[name]) for name in ("ncols", "nrows"))
            check_size(path, nrows, ncols)
            dx, dy = (header.get(name, header.get("cellsize", 0.0)) for name in ("dx", "dy"))
            if not (0.0 < dx < np.inf and 0.0 < dy < np.inf):
                raise ValueError("its header has no cellsize above 0")
            values = np.empty(nrows * ncols)
            at = 0
            while first or (block := "".join(islice(lines, LINES))):
                part = np.array((first or block).split(), np.float64)
                first = ""
                if at + part.size > values.size:
                    raise ValueError(f"it holds more than its {nrows} x {ncols} numbers")
                values[at : at + part.size] = part
                at += part.size
            if at != values.size:
                raise ValueError(f"it ends after {at} of {nrows} x {ncols} numbers")
            x0 = header["xllcorner"] if "xllcorner" in header else header["xllcenter"] - 0.5 * dx
            y0 = header["yllcorner"] if "yllcorner" in header else header["yllcenter"] - 0.5 * dy
    except KeyError as error:
        raise TerrainError(f"File '{path.name}' is no ESRI ASCII grid: its header has no {error}.") from error
    except (OSError, ValueError, OverflowError) as error:
        raise TerrainError(f"File '{path.name}' cannot be read as an ESRI ASCII grid: {error}.") from error
    north_first = one_mask(values.reshape(nrows, ncols), header.get("nodata_value", NODATA))
    return Raster(np.ascontiguousarray(north_first[::-1]), x0, y0, dx, dy, _system(path))


def _header(lines: Iterator[str]) -> tuple[dict[str, float], str]:
    """Names and numbers of the header, and the first line after it."""
    header: dict[str, float] = {}
    for line in lines:
        words = line.split()
        if len(words) != 2 or words[0].lower() not in NAMES:
            return header, line
        header[words[0].lower()] = float(words[1])
    return header, ""


def _system(path: Path) -> str | None:
    beside = path.with_suffix(".prj")
    if not beside.is_file() or beside.is_symlink():
        return None
    return beside.read_text(encoding="utf-8", errors="replace")[:65536].strip() or None
