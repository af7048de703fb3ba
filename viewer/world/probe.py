"""What is at a place: ground, depth and water level under the cursor."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from viewer.world.heightfield import Heightfield

__all__ = ["ProbeReading", "probe"]


@dataclass(frozen=True)
class ProbeReading:
    """One reading, in the units of the case."""

    x: float
    """Easting [m]."""
    y: float
    """Northing [m]."""
    row: int
    col: int
    ground: float
    """Elevation of the ground in this cell [m above the vertical datum]."""
    depth: float
    """Depth of water in this cell [m]; 0 where dry."""
    level: float | None
    """Water level [m above the vertical datum]; None where dry."""


def probe(
    heightfield: Heightfield,
    x: float,
    y: float,
    h_first: npt.NDArray[np.float32] | None = None,
    h_second: npt.NDArray[np.float32] | None = None,
    alpha: float = 0.0,
) -> ProbeReading | None:
    """Read the cell at a place, blended between two frames as the picture is.

    Args:
        heightfield: the ground.
        x: easting [m].
        y: northing [m].
        h_first: depth of the frame before [m], shape [nrows, ncols]; None for no water.
        h_second: depth of the frame after; None means the same as the first.
        alpha: 0 for the first, 1 for the second.

    Returns:
        the reading, or None outside the grid.
    """
    grid = heightfield.grid
    col = int(np.floor((x - grid.x0) / grid.dx))
    row = int(np.floor((y - grid.y0) / grid.dx))
    if not (0 <= row < grid.nrows and 0 <= col < grid.ncols):
        return None
    depth = 0.0
    if h_first is not None:
        later = h_first if h_second is None else h_second
        depth = (1.0 - alpha) * float(h_first[row, col]) + alpha * float(later[row, col])
    ground = float(heightfield.z_b[row, col]) + grid.datum_offset
    return ProbeReading(x, y, row, col, ground, depth, ground + depth if depth > 0.0 else None)
