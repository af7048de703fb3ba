"""Where the front of a flood is, and where a levee would stand in its way.

The front at a frame is where most of the newly wetted ground lies: cells wet in this frame and dry in an
earlier one, weighed by their depth, gathered in squares of `PATCH` cells. The levee is put where the water
will come a while later, where a short one, with both ends on high ground, keeps much ground dry.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

import protocol

__all__ = ["Front", "LeveeLine", "find_front", "place_levee"]

Depth = npt.NDArray[np.float32]
Mask = npt.NDArray[np.bool_]

PATCH = 12
"""Side of the squares in which new water is gathered [cells]."""
WET = 0.05
"""Depth from which a cell counts as reached [m]."""
FREEBOARD = 8.0
"""Height of the levee over the water it must hold [m]."""
HEIGHT_RANGE = (6.0, 40.0)
HALF_LENGTH = 80
"""Most cells from the path of the water to an end of the levee."""
BEARINGS = 16
"""Number of directions that are tried."""
WIDTH_CELLS = 3.0
POOL = 3
"""Side of the squares in which the path of the water round a levee is looked for [cells]."""
LENGTH_OFFSET_CELLS = 15.0
"""Added to the length of a levee when it is weighed against the ground it keeps dry [cells]."""


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
    """

    start: tuple[float, float]
    end: tuple[float, float]
    width: float
    height: float

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
    grid: protocol.GridGeometry, z_b: Depth, places: Sequence[tuple[float, float]], now: Depth, later: Depth
) -> LeveeLine | None:
    """Return the levee ahead of the front that keeps most ground dry for its length, if any would hold.

    A levee holds when both of its ends stand on ground that stays dry and lies above the later water by the
    freeboard. It must not touch water that is there already.

    Args:
        grid: the terrain's grid.
        z_b: bed [m, datum-relative].
        places: (row, col) through which the water will come, fractions allowed.
        now: depth when the levee is drawn [m].
        later: depth when the water has come [m].
    """
    reached, source = _pooled(later > WET), _pooled(now > WET)
    best: LeveeLine | None = None
    best_worth = 0.0
    for place in places:
        levees = [
            found
            for turn in range(BEARINGS)
            if (found := _levee_at(grid, z_b, place, turn * math.pi / BEARINGS, now, later)) is not None
        ]
        if not levees:
            continue
        shortest = min(levees, key=lambda levee: levee.length)
        kept_dry = _kept_dry(reached, source, _pooled(_cells_of(shortest, grid)))
        worth = kept_dry / (shortest.length + LENGTH_OFFSET_CELLS * grid.dx)
        if worth > best_worth:
            best, best_worth = shortest, worth
    return best


def _kept_dry(reached: Mask, source: Mask, barrier: Mask) -> int:
    """Return how many `reached` squares the water no longer reaches from `source` round the `barrier`."""
    free = reached & ~barrier
    wet = source & free
    while True:
        grown = wet.copy()
        grown[1:] |= wet[:-1]
        grown[:-1] |= wet[1:]
        grown[:, 1:] |= wet[:, :-1]
        grown[:, :-1] |= wet[:, 1:]
        grown &= free
        if np.array_equal(grown, wet):
            return int(np.count_nonzero(free & ~wet))
        wet = grown


def _pooled(mask: Mask) -> Mask:
    """Return which squares of `POOL` x `POOL` cells hold a cell of the mask."""
    rows, cols = (-(-side // POOL) * POOL for side in mask.shape)
    padded = np.zeros((rows, cols), dtype=np.bool_)
    padded[: mask.shape[0], : mask.shape[1]] = mask
    pooled: Mask = padded.reshape(rows // POOL, POOL, cols // POOL, POOL).max(axis=(1, 3))
    return pooled


def _cells_of(levee: LeveeLine, grid: protocol.GridGeometry) -> Mask:
    edit = protocol.EditLine(
        id="levee",
        vertices=(levee.start, levee.end),
        width=max(levee.width, 2.0 * POOL * grid.dx),
        operation=protocol.Operation.raise_,
        type=protocol.EditType.modulate,
        magnitude=levee.height,
    )
    mask = np.zeros(grid.shape, dtype=np.bool_)
    rows, cols, _ = protocol.rasterise_edit(edit, grid)
    mask[rows, cols] = True
    return mask


def _levee_at(
    grid: protocol.GridGeometry,
    z_b: Depth,
    place: tuple[float, float],
    angle: float,
    now: Depth,
    later: Depth,
) -> LeveeLine | None:
    """Return the levee through `place` along the direction `angle` [rad], None when it would not hold."""
    along = (math.cos(angle), math.sin(angle))
    steps = np.arange(-HALF_LENGTH, HALF_LENGTH + 1)
    rows = np.rint(place[0] + along[0] * steps).astype(np.intp)
    cols = np.rint(place[1] + along[1] * steps).astype(np.intp)
    inside = (rows >= 1) & (rows < z_b.shape[0] - 1) & (cols >= 1) & (cols < z_b.shape[1] - 1)
    if not inside[HALF_LENGTH]:
        return None
    rows, cols = np.clip(rows, 0, z_b.shape[0] - 1), np.clip(cols, 0, z_b.shape[1] - 1)
    ground, water = z_b[rows, cols], later[rows, cols]
    middle = slice(HALF_LENGTH - 2, HALF_LENGTH + 3)
    if not (water[middle] > WET).any():
        return None
    crest = float((ground + water)[middle][water[middle] > WET].max()) + FREEBOARD
    holds = (ground > crest) & (water <= WET) & inside
    left, right = np.flatnonzero(holds[:HALF_LENGTH]), np.flatnonzero(holds[HALF_LENGTH + 1 :])
    if left.size == 0 or right.size == 0:
        return None
    first, last = int(left[-1]), HALF_LENGTH + 1 + int(right[0])
    line = slice(first, last + 1)
    near = [
        (slice(max(r - 2, 0), r + 3), slice(max(c - 2, 0), c + 3))
        for r, c in zip(rows[line], cols[line], strict=True)
    ]
    if any((now[window] > WET).any() for window in near):
        return None
    height = min(max(crest - float(ground[line].min()), HEIGHT_RANGE[0]), HEIGHT_RANGE[1])
    ends = [grid.center(float(rows[at]), float(cols[at])) for at in (first, last)]
    return LeveeLine(ends[0], ends[1], WIDTH_CELLS * grid.dx, float(math.ceil(height)))
