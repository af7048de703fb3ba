"""SRTM tiles: big-endian int16 metres, north first, named after their south-western corner.

Samples lie on the corners of whole degrees (point registered), so the edge of the outer cells is half a cell
further out. A tile has 1201 x 1201 samples (3 arc-seconds) or 3601 x 3601 (1 arc-second).
"""

from __future__ import annotations

import math
import re
import zipfile
from pathlib import Path

import numpy as np

from solver_service.errors import TerrainError
from solver_service.terrain.raster import BROKEN_ARCHIVE, Raster, one_mask

NAME = re.compile(r"([NS])(\d{2})([EW])(\d{3})", re.IGNORECASE)
SIDES = (1201, 3601)
VOID = -32768.0


def read_srtm(path: Path) -> Raster:
    """Read a .hgt tile, or the first .hgt of a .hgt.zip.

    Raises:
        TerrainError: the name tells no corner, or the size is not that of a tile.
    """
    corner = NAME.match(path.name)
    if corner is None:
        raise TerrainError(f"File '{path.name}' is not named like an SRTM tile, for example N49E011.hgt.")
    data = _unpacked(path) if path.suffix.lower() == ".zip" else _plain(path)
    side = math.isqrt(len(data) // 2)
    if side not in SIDES or 2 * side * side != len(data):
        raise TerrainError(
            f"SRTM tile '{path.name}' holds {len(data)} bytes; 1201 x 1201 or 3601 x 3601 samples of 2 bytes"
            " are allowed."
        )
    north, lat, east, lon = corner.groups()
    south = int(lat) if north in "Nn" else -int(lat)
    west = int(lon) if east in "Ee" else -int(lon)
    step = 1.0 / (side - 1)
    values = one_mask(np.frombuffer(data, dtype=">i2").reshape(side, side), VOID)[::-1]
    return Raster(values, west - 0.5 * step, south - 0.5 * step, step, step, "EPSG:4326")


def _plain(path: Path) -> bytes:
    try:
        if path.stat().st_size > 2 * max(SIDES) ** 2:
            raise TerrainError(
                f"SRTM tile '{path.name}' is larger than any tile ({2 * max(SIDES) ** 2} bytes)."
            )
        return path.read_bytes()
    except OSError as error:
        raise TerrainError(f"File '{path.name}' cannot be read: {error.strerror}.") from error


def _unpacked(path: Path) -> bytes:
    try:
        with zipfile.ZipFile(path) as archive:
            tiles = [info for info in archive.infolist() if info.filename.lower().endswith(".hgt")]
            if len(tiles) != 1:
                raise TerrainError(f"Archive '{path.name}' holds {len(tiles)} .hgt files; one is allowed.")
            if tiles[0].file_size > 2 * max(SIDES) ** 2:
                raise TerrainError(f"The tile in '{path.name}' is larger than any SRTM tile.")
            return archive.read(tiles[0])
    except BROKEN_ARCHIVE as error:
        raise TerrainError(f"Archive '{path.name}' cannot be read: {error}.") from error
