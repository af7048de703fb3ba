"""SELAFIN meshes (TELEMAC .slf, also gzipped): bed elevations, linear on the mesh's own triangles.

The file is a chain of big-endian Fortran records, each between two 4-byte lengths: title, number of
variables, their names (32 bytes each), ten integers (the last 1: a date record follows), NELEM
NPOIN NDP 1, triangles (1-based), boundary index, x, y, and for each time the time and each variable.
"""

from __future__ import annotations

import gzip
import math
import struct
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from solver_service.errors import TerrainError
from solver_service.terrain.raster import BROKEN_ARCHIVE, Raster, check_size

MAX_FILE_BYTES = 1 << 30
BED_NAMES = ("BOTTOM", "FOND", "BATHYMETRY")


@dataclass(frozen=True)
class Mesh:
    """A triangle mesh with a bed.

    Attributes:
        x: x of the nodes [m].
        y: y of the nodes [m].
        z: bed elevation of the nodes [m].
        triangles: node numbers from 0 [n, 3].
    """

    x: NDArray[np.float64]
    y: NDArray[np.float64]
    z: NDArray[np.float64]
    triangles: NDArray[np.int64]


def read_selafin(
    path: Path, cell_size: float | None, bounds: tuple[float, float, float, float] | None = None
) -> Raster:
    """Read the bed of a mesh onto square cells.

    Args:
        path: the .slf or .slf.gz file.
        cell_size: cell size [m].
        bounds: outer edges xmin, ymin, xmax, ymax [m]; None for the mesh's own, outwards to whole cells.

    Returns:
        The bed at the cell centres, NaN outside the mesh.

    Raises:
        TerrainError: the file is not a SELAFIN mesh with a bed, or no cell size is given.
    """
    if cell_size is None:
        raise TerrainError(f"Mesh '{path.name}' has no cells of its own; [terrain] cell_size in m is needed.")
    mesh = read_mesh(path)
    dx = cell_size
    if bounds is None:
        xmin, ymin = math.floor(mesh.x.min() / dx) * dx, math.floor(mesh.y.min() / dx) * dx
        bounds = (xmin, ymin, float(mesh.x.max()), float(mesh.y.max()))
    ncols = max(1, math.ceil((bounds[2] - bounds[0]) / dx - 1e-6))
    nrows = max(1, math.ceil((bounds[3] - bounds[1]) / dx - 1e-6))
    check_size(path, nrows, ncols)
    return Raster(interpolate(mesh, bounds[0], bounds[1], dx, nrows, ncols), bounds[0], bounds[1], dx, dx)


def read_mesh(path: Path) -> Mesh:
    """Read nodes, triangles and the bed of the first time.

    Raises:
        TerrainError: the file is not a SELAFIN mesh with a bed.
    """
    try:
        with path.open("rb") as packed:
            zipped = path.suffix.lower() == ".gz"
            data = (gzip.GzipFile(fileobj=packed) if zipped else packed).read(MAX_FILE_BYTES + 1)
    except BROKEN_ARCHIVE as error:
        raise TerrainError(f"Mesh '{path.name}' cannot be read: {error}.") from error
    if len(data) > MAX_FILE_BYTES:
        raise TerrainError(f"Mesh '{path.name}' is larger than {MAX_FILE_BYTES} bytes unpacked.")
    try:
        return _parse(_records(data))
    except (struct.error, ValueError, IndexError, StopIteration) as error:
        raise TerrainError(
            f"File '{path.name}' is not a SELAFIN mesh: {str(error) or 'it ends early'}."
        ) from error


def _records(data: bytes) -> list[bytes]:
    records, at = [], 0
    while at + 8 <= len(data):
        (size,) = struct.unpack_from(">i", data, at)
        if size < 0 or at + 8 + size > len(data) or struct.unpack_from(">i", data, at + 4 + size)[0] != size:
            raise ValueError(f"the record at byte {at} has no closing length of {size}")
        records.append(data[at + 4 : at + 4 + size])
        at += 8 + size
    return records


def _parse(records: list[bytes]) -> Mesh:
    stream = iter(records)
    next(stream)
    linear, quadratic = struct.unpack(">2i", next(stream))
    if not 1 <= linear + quadratic <= 100:
        raise ValueError(f"it has {linear + quadratic} variables; 1 to 100 are allowed")
    names = [next(stream).decode("latin-1").upper() for _ in range(linear + quadratic)]
    parameters = struct.unpack(">10i", next(stream))
    if parameters[9] == 1:
        next(stream)
    elements, nodes, corners, _ = struct.unpack(">4i", next(stream))
    if corners != 3:
        raise ValueError(f"its elements have {corners} corners; triangles are allowed")
    triangles = np.frombuffer(next(stream), ">i4").reshape(elements, 3).astype(np.int64) - 1
    if triangles.min() < 0 or triangles.max() >= nodes:
        raise ValueError(f"its triangles name nodes outside 1 to {nodes}")
    next(stream)
    x, y = [_floats(next(stream), nodes) for _ in range(2)]
    next(stream)
    bed = next((k for k, name in enumerate(names) if name.startswith(BED_NAMES)), None)
    if bed is None:
        found = ", ".join(name.strip() for name in names)
        raise ValueError(f"its variables are {found}; one named BOTTOM or FOND is needed")
    z = [_floats(next(stream), nodes) for _ in names][bed]
    if not (np.isfinite(x).all() and np.isfinite(y).all() and np.isfinite(z).all()):
        raise ValueError("a node is not finite")
    return Mesh(x, y, z, triangles)


def _floats(record: bytes, count: int) -> NDArray[np.float64]:
    kind = {4 * count: ">f4", 8 * count: ">f8"}.get(len(record))
    if kind is None:
        raise ValueError(f"a record of {len(record)} bytes stands where {count} numbers must be")
    return np.frombuffer(record, kind).astype(np.float64)


def interpolate(mesh: Mesh, x0: float, y0: float, dx: float, nrows: int, ncols: int) -> NDArray[np.float32]:
    """Bed at cell centres, linear on the triangles [m]; NaN outside all of them.

    Args:
        mesh: the mesh.
        x0: x of the south-western corner of the cells [m].
        y0: y of the south-western corner of the cells [m].
        dx: cell size [m].
        nrows: rows of cells.
        ncols: columns of cells.
    """
    out = np.full(nrows * ncols, np.nan, np.float32)
    cx = (mesh.x[mesh.triangles] - x0) / dx - 0.5
    cy = (mesh.y[mesh.triangles] - y0) / dx - 0.5
    first_col = np.clip(np.ceil(cx.min(axis=1) - 1e-9), 0, ncols).astype(np.int64)
    first_row = np.clip(np.ceil(cy.min(axis=1) - 1e-9), 0, nrows).astype(np.int64)
    wide = np.clip(np.floor(cx.max(axis=1) + 1e-9).astype(np.int64) + 1, 0, ncols) - first_col
    high = np.clip(np.floor(cy.max(axis=1) + 1e-9).astype(np.int64) + 1, 0, nrows) - first_row
    candidates = np.maximum(wide, 0) * np.maximum(high, 0)
    for part in _parts(candidates, 1 << 22):
        triangle = np.repeat(part, candidates[part])
        start = np.repeat(np.cumsum(candidates[part]) - candidates[part], candidates[part])
        place = np.arange(triangle.size) - start
        row = first_row[triangle] + place // wide[triangle]
        col = first_col[triangle] + place % wide[triangle]
        a, b, weight_0, weight_1 = _barycentric(cx[triangle], cy[triangle], col, row)
        inside = (weight_0 >= -1e-9) & (weight_1 >= -1e-9) & (weight_0 + weight_1 <= 1.0 + 1e-9) & (a != b)
        z = mesh.z[mesh.triangles[triangle[inside]]]
        w0, w1 = weight_0[inside], weight_1[inside]
        value = w0 * z[:, 0] + w1 * z[:, 1] + (1.0 - w0 - w1) * z[:, 2]
        out[row[inside] * ncols + col[inside]] = value
    return out.reshape(nrows, ncols)


def _parts(counts: NDArray[np.int64], size: int) -> list[NDArray[np.int64]]:
    """Triangle numbers with a candidate, in runs of about `size` candidates each."""
    used = np.flatnonzero(counts > 0)
    if used.size == 0:
        return []
    chunk = np.cumsum(counts[used]) // size
    return np.split(used, np.flatnonzero(np.diff(chunk)) + 1)


def _barycentric(
    cx: NDArray[np.float64], cy: NDArray[np.float64], col: NDArray[np.int64], row: NDArray[np.int64]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    a = (cy[:, 1] - cy[:, 2]) * (cx[:, 0] - cx[:, 2])
    b = (cx[:, 1] - cx[:, 2]) * (cy[:, 0] - cy[:, 2])
    area = np.where(a == b, 1.0, a - b)
    px, py = col - cx[:, 2], row - cy[:, 2]
    weight_0 = ((cy[:, 1] - cy[:, 2]) * px - (cx[:, 1] - cx[:, 2]) * py) / area
    weight_1 = ((cx[:, 0] - cx[:, 2]) * py - (cy[:, 0] - cy[:, 2]) * px) / area
    return a, b, weight_0, weight_1
