"""Where the front of a flood is, and where a levee would stand in its way.

The front at a frame is where most of the newly wetted ground lies: cells wet in this frame and dry in an
earlier
one, weighed by their depth, gathered in squares of `PATCH` cells. The levee is put where the front will be
a while
later, across the direction in which it moves there, and so long that it ends on ground above the later water.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

import protocol

__all__ = ["Front", "LeveeLine", "find_front", "place_levee"]

Depth = npt.NDArray[np.float32]

PATCH = 12
"""Side of the squares in which new water is gathered [cells]."""
WET = 0.05
"""Depth from which a cell counts as reached [m]."""
FREEBOARD = 4.0
"""Height of the levee over the water it must hold [m]."""
HEIGHT_RANGE = (6.0, 40.0)
HALF_LENGTH_RANGE = (6, 90)
"""Half of the levee's length [cells]."""


@dataclass(frozen=True)
class Front:
    """Fractional row and column of the front, and how many cells are newly wet."""

    row: float
    col: float
    new_cells: int


@dataclass(frozen=True)
class LeveeLine:
    """A levee across the path of the water.

    Attributes:
        start: one end (x, y) [m].
        end: the other end (x, y) [m].
        width: [m]
        height: by which the ground is raised [m].
        bearing: direction in which the water moves there, clockwise from north [deg].
    """

    start: tuple[float, float]
    end: tuple[float, float]
    width: float
    height: float
    bearing: float

    @property
    def middle(self) -> tuple[float, float]:
        """The point half way (x, y) [m]."""
        return 0.5 * (self.start[0] + self.end[0]), 0.5 * (self.start[1] + self.end[1])

    @property
    def length(self) -> float:
        """Length [m]."""
        return math.dist(self.start, self.end)


def find_front(before: Depth, after: Depth) -> Front | None:
    """Return where the ground newly wet between two frames mostly lies; None when no ground was reached.

    Args:
        before: depth of the earlier frame [m], shape [nrows, ncols].
        after: depth of the later frame [m].
    """
    new_water = np.where((after > WET) & (before <= WET), after, np.float32(0.0))
    rows, cols = np.nonzero(new_water)
    if rows.size == 0:
        return None
    depths = new_water[rows, cols].astype(np.float64)
    patch_cols = after.shape[1] // PATCH + 1
    patches = (rows // PATCH) * patch_cols + cols // PATCH
    fullest = int(np.argmax(np.bincount(patches, weights=depths)))
    near = (np.abs(rows // PATCH - fullest // patch_cols) <= 1) & (
        np.abs(cols // PATCH - fullest % patch_cols) <= 1
    )
    weights = depths[near] / depths[near].sum()
    return Front(float(weights @ rows[near]), float(weights @ cols[near]), int(rows.size))


def place_levee(
    grid: protocol.GridGeometry,
    z_b: Depth,
    front: tuple[float, float],
    heading: tuple[float, float],
    water: Depth,
) -> LeveeLine:
    """Return a levee through `front`, across `heading`.

    Args:
        grid: the terrain's grid.
        z_b: bed [m, datum-relative].
        front: fractional (row, col) where it shall stand.
        heading: direction (rows, cols) in which the water moves there; any length above 0.
        water: depth later, when water stands where the levee shall [m].
    """
    length = math.hypot(*heading)
    ahead = (heading[0] / length, heading[1] / length)
    across = (ahead[1], -ahead[0])
    row, col = (min(max(round(at), 0), side - 1) for at, side in zip(front, z_b.shape, strict=True))
    near = (slice(max(row - 3, 0), row + 4), slice(max(col - 3, 0), col + 4))
    wet = water[near] > WET
    level = float((z_b[near] + water[near])[wet].max()) if wet.any() else float(z_b[row, col])
    crest = level + FREEBOARD
    ends = []
    lowest = float(z_b[row, col])
    for sign in (1.0, -1.0):
        reach = HALF_LENGTH_RANGE[0]
        for step in range(1, HALF_LENGTH_RANGE[1] + 1):
            r, c = round(front[0] + sign * step * across[0]), round(front[1] + sign * step * across[1])
            if not (1 <= r < z_b.shape[0] - 1 and 1 <= c < z_b.shape[1] - 1):
                break
            reach = max(step, HALF_LENGTH_RANGE[0])
            lowest = min(lowest, float(z_b[r, c]))
            if z_b[r, c] > crest:
                break
        end_row = min(max(front[0] + sign * reach * across[0], 0.0), z_b.shape[0] - 1.0)
        end_col = min(max(front[1] + sign * reach * across[1], 0.0), z_b.shape[1] - 1.0)
        ends.append(grid.center(end_row, end_col))
    height = min(max(crest - lowest, HEIGHT_RANGE[0]), HEIGHT_RANGE[1])
    bearing = math.degrees(math.atan2(ahead[1], ahead[0])) % 360.0
    return LeveeLine(ends[0], ends[1], 3.0 * grid.dx, math.ceil(height), bearing)
