"""How long an edit is and how much ground it moves, as the solver will apply it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from protocol import Edit, EditArea, GridGeometry, edited_cells, rasterise_edit

__all__ = ["EditMeasure", "measure_edits"]


@dataclass(frozen=True)
class EditMeasure:
    """An edit in numbers."""

    length: float
    """Length of the line, or of the border of the area [m]."""
    volume: float
    """Ground filled (positive) or cut (negative) on what the edits before it have left [m3]."""
    rows: npt.NDArray[np.int32]
    """Rows of the cells that the edit raises."""
    cols: npt.NDArray[np.int32]
    """Their columns."""


def measure_edits(
    z_b: npt.NDArray[np.float32], edits: Sequence[Edit], grid: GridGeometry
) -> tuple[EditMeasure, ...]:
    """Measure edits that apply one after the other.

    Args:
        z_b: bed before the first of them [m], shape [nrows, ncols].
        edits: the edits in order.
        grid: geometry of the bed.

    Raises:
        protocol.EditError: an edit does not fit the terrain.
    """
    cells = [rasterise_edit(edit, grid) for edit in edits]
    covered = [(rows, cols) for rows, cols, _ in cells if rows.size]
    if not covered:
        return tuple(
            EditMeasure(_length(edit), 0.0, rows, cols)
            for edit, (rows, cols, _) in zip(edits, cells, strict=True)
        )
    row0, col0 = (min(int(part[axis].min()) for part in covered) for axis in (0, 1))
    row1, col1 = (max(int(part[axis].max()) for part in covered) + 1 for axis in (0, 1))
    z = z_b[row0:row1, col0:col1].copy()  # what the edits cover, not the whole grid
    measures = []
    for edit, (rows, cols, position) in zip(edits, cells, strict=True):
        place = (rows - row0, cols - col0)
        before = z[place]
        z[place] = edited_cells(before, edit, position, grid)
        rise = z[place].astype(np.float64) - before
        raised = rise > 0.0
        volume = float(rise.sum()) * grid.dx * grid.dx
        measures.append(EditMeasure(_length(edit), volume, rows[raised], cols[raised]))
    return tuple(measures)


def _length(edit: Edit) -> float:
    points = list(edit.vertices)
    if isinstance(edit, EditArea):
        points.append(points[0])
    return math.fsum(math.dist(a, b) for a, b in pairwise(points))
