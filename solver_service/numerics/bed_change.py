"""A new bed under water: a levee drawn, a trench dug.

Where the bed rises by dz the water column is cut, h' = max(h - dz, 0), so that the surface keeps its level
where it stays wet; where the bed sinks h stays. Velocities stay, zero where the cell falls dry. What was
cut is booked.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from solver_service.errors import ModelError
from solver_service.numerics.fields import FieldStore, FloatRaster


@dataclass(frozen=True)
class BedChange:
    """What a change of the bed did."""

    volume_cut: float
    """Water that the rising bed displaced [m3]."""
    changed_cells: int
    """Cells whose bed is not what it was."""


def check_bed(z_b: npt.ArrayLike, shape: tuple[int, int]) -> FloatRaster:
    """The bed as float32.

    Raises:
        ModelError: when shape or values are not valid.
    """
    bed = np.ascontiguousarray(z_b, np.float32)
    if bed.shape != shape:
        raise ModelError(f"The new bed has the shape {bed.shape}; the grid's is {shape}.")
    bad = np.argwhere(~np.isfinite(bed))
    if bad.size:
        row, col = bad[0]
        raise ModelError(
            f"The new bed is {bed[row, col]} in cell (row {row}, column {col}); finite is allowed."
        )
    return bed


def change_water(
    store: FieldStore, z_before: FloatRaster, z_after: FloatRaster, depth_dry: float, dx: float
) -> BedChange:
    """Cut the water where the bed rose; both states get the result.

    Args:
        store: rasters of the run.
        z_before: bed so far [m], [nrows, ncols].
        z_after: new bed [m], [nrows, ncols].
        depth_dry: depth without velocity [m].
        dx: cell side [m].
    """
    changed = z_after != z_before
    count = int(np.count_nonzero(changed))
    h = store.read("h")
    rise = z_after[changed] - z_before[changed]
    before = h[changed]
    after = np.where(rise > 0.0, np.maximum(before - rise, np.float32(0.0)), before)
    cut = float((before.astype(np.float64) - after).sum()) * dx * dx
    h[changed] = after
    dry = changed & (h <= depth_dry)
    for name in ("u", "v"):
        velocity = store.read(name)
        velocity[dry] = 0.0
        store.write(name, velocity)
    store.write("h", h)
    return BedChange(cut, count)
