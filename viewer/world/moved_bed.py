"""The bed where breaches have moved it: few cells that lie otherwise than base and edits say."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from viewer.world.heightfield import Rect

__all__ = ["MovedBed", "bed_with", "blended_bed"]

Cells = npt.NDArray[np.int64]
Elevations = npt.NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class MovedBed:
    """Cells of one bed that has moved."""

    cells: Cells
    """Flat indices, row x ncols + col, rising, shape [k]."""
    z_b: Elevations
    """The bed there [m, datum-relative], shape [k]."""
    before: Elevations
    """The bed of base and edits there, which had not moved [m, datum-relative], shape [k]."""

    def rect(self, ncols: int) -> Rect | None:
        """The smallest rectangle that holds the cells; None for no cell."""
        if not self.cells.size:
            return None
        rows, cols = np.divmod(self.cells, ncols)
        return int(rows.min()), int(cols.min()), int(rows.max()) + 1, int(cols.max()) + 1

    def on(self, ground: Elevations) -> Elevations:
        """The bed in these cells when the ground before the breach is `ground`, shape [k].

        Where an edit that was not computed yet lies on the ground, it keeps its height above the bed.
        """
        moved: Elevations = np.where(ground == self.before, self.z_b, ground + (self.z_b - self.before))
        return moved


def bed_with(bed: Elevations, moved: MovedBed) -> Elevations:
    """A copy of a bed, shape [nrows, ncols], with the cells that have moved."""
    laid = bed.copy()
    laid.ravel()[moved.cells] = moved.z_b
    return laid


def blended_bed(first: MovedBed | None, second: MovedBed | None, alpha: float) -> MovedBed | None:
    """What has moved between two frames, blended as the depth is; None when nothing has in either."""
    if first is second or alpha == 0.0:
        return first
    if alpha == 1.0:
        return second
    parts = [part for part in (first, second) if part is not None]
    cells = np.unique(np.concatenate([part.cells for part in parts]))
    before = np.empty(cells.size, np.float32)
    for part in parts:
        before[np.searchsorted(cells, part.cells)] = part.before
    beds = []
    for at in (first, second):
        bed = before.copy()
        if at is not None:
            bed[np.searchsorted(cells, at.cells)] = at.z_b
        beds.append(bed)
    share = np.float32(alpha)
    return MovedBed(cells, beds[0] * (np.float32(1.0) - share) + beds[1] * share, before)
