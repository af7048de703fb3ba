"""Edits onto the bed.

With s = +1 to raise and -1 to lower, m the magnitude and z the bed so far:

    modulate         z' = z + s m
    replace, raise   z' = max(z, L)
    replace, lower   z' = min(z, L)
    L = level - datum_offset, or z_ref + s m

z_ref is the ground at the drawn vertices, interpolated at the nearest point of the line, or its mean
for an area. L is computed in float64 and rounded to float32 once; everything else is float32. Edits apply in
list order.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from protocol.edits.model import Edit, EditType
from protocol.edits.raster import Float64Array, rasterise_edit
from protocol.errors import EditError
from protocol.grid import GridGeometry

FloatArray = npt.NDArray[np.float32]
Rectangle = tuple[int, int, int, int]


@dataclass(frozen=True)
class EditedBed:
    """A bed with edits applied.

    Attributes:
        z_b: the bed [m], float32 [nrows, ncols], a new array.
        dirty: (row0, row1, col0, col1), ends excluded, outside which nothing is edited; or none.
        raised: +1 where the bed is higher than the base, -1 where lower, 0 where equal; int8 over the dirty
            rectangle, or an empty array.
    """

    z_b: FloatArray
    dirty: Rectangle | None
    raised: npt.NDArray[np.int8]


def apply_edits(z_b_base: npt.ArrayLike, edits: Iterable[Edit], grid: GridGeometry) -> EditedBed:
    """Apply a list of edits to the base bed.

    Args:
        z_b_base: bed before any edit [m, relative to grid.datum_offset], shape grid.shape; left as it is.
        edits: the edits in order.
        grid: the grid of the bed.

    Returns:
        The edited bed and where it changed.

    Raises:
        EditError: when the bed does not fit the grid, or an edit covers too many cells.
    """
    base = np.asarray(z_b_base, dtype=np.float32)
    if base.shape != grid.shape:
        raise EditError(f"The bed has the shape {base.shape}; {grid.shape} is allowed.")
    z_b = base.copy()
    dirty: Rectangle | None = None
    for edit in edits:
        rows, cols, position = rasterise_edit(edit, grid)
        if rows.size == 0:
            continue
        z_b[rows, cols] = edited_cells(z_b[rows, cols], edit, position, grid)
        box = (int(rows[0]), int(rows[-1]) + 1, int(cols.min()), int(cols.max()) + 1)
        dirty = box if dirty is None else _union(dirty, box)
    if dirty is None:
        return EditedBed(z_b, None, np.zeros((0, 0), dtype=np.int8))
    window = (slice(dirty[0], dirty[1]), slice(dirty[2], dirty[3]))
    return EditedBed(z_b, dirty, np.sign(z_b[window] - base[window]).astype(np.int8))


def edited_cells(z: FloatArray, edit: Edit, position: Float64Array | None, grid: GridGeometry) -> FloatArray:
    """The new bed of the cells that an edit covers.

    Args:
        z: their bed so far [m, relative to grid.datum_offset], shape [n].
        edit: the edit.
        position: where along the line each of them lies, from `rasterise_edit`.
        grid: the grid of the bed.
    """
    sign = edit.operation.sign
    if edit.type is EditType.modulate:
        return z + np.float32(sign * edit.magnitude)
    target = _target(edit, position, grid)
    return np.maximum(z, target) if sign > 0 else np.minimum(z, target)


def _target(edit: Edit, position: Float64Array | None, grid: GridGeometry) -> FloatArray | np.float32:
    """The L of the formulas."""
    if edit.level is not None:
        return np.float32(edit.level - grid.datum_offset)
    reference = np.array(edit.reference_z, dtype=np.float64)
    change = edit.operation.sign * edit.magnitude
    if position is None:
        return np.float32(sum(reference.tolist()) / reference.size + change)
    # Elementwise steps, not np.interp: a compiler may fuse its multiply and add, and the bits would differ.
    start = np.minimum(position.astype(np.int64), reference.size - 2)
    rise = (reference[start + 1] - reference[start]) * (position - start)
    target: FloatArray = (reference[start] + rise + change).astype(np.float32)
    return target


def _union(a: Rectangle, b: Rectangle) -> Rectangle:
    return (min(a[0], b[0]), max(a[1], b[1]), min(a[2], b[2]), max(a[3], b[3]))
