"""The ground on the CPU: one elevation per cell centre, sampled between centres, and what lies on it.

The array is [row, col] with row 0 in the south; z is relative to the case datum. A revision number and the
rectangles changed since a revision tell the textures and the level-of-detail errors what to refresh.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from protocol import GridGeometry
from viewer.errors import TerrainDataError
from viewer.world.apron import continued
from viewer.world.coordinates import WorldFrame

__all__ = ["Heightfield", "Rect", "union_rect"]

Rect = tuple[int, int, int, int]
"""A rectangle of cells: first row, first column, end row, end column (ends exclusive)."""

_HISTORY_LENGTH = 64


def union_rect(first: Rect | None, second: Rect | None) -> Rect | None:
    """The smallest rectangle that holds both; None stands for an empty one."""
    if first is None or second is None:
        return first if second is None else second
    return (
        min(first[0], second[0]),
        min(first[1], second[1]),
        max(first[2], second[2]),
        max(first[3], second[3]),
    )


class Heightfield:
    """The ground as it is now: the bed of the run with the user's edits on it.

    Attributes:
        grid: the geometry of the raster.
        z_b: the bed [m, datum-relative].
        drawn: the bed as pictures show it: outside of the data the ground is continued, not walled.
        outside: cells without data; None where there are none.
        imagery: a picture of the ground that covers the grid, [rows, cols, 3] uint8, row 0 in the south.
        cover_revision: counts the changes of `outside` and `imagery`.
        revision: counts the changes of the bed.
        z_min: lowest ground drawn so far [m].
        z_max: highest ground drawn so far [m].
        frame: the world frame of pictures.
    """

    def __init__(
        self, grid: GridGeometry, z_b: npt.ArrayLike, outside: npt.NDArray[np.bool_] | None = None
    ) -> None:
        """Take the first bed.

        Args:
            grid: the geometry of the raster.
            z_b: bed elevation [m, datum-relative], shape [nrows, ncols], finite.
            outside: cells without data, shape [nrows, ncols]; None for none.

        Raises:
            TerrainDataError: if a shape is not the grid's or a value is not finite.
        """
        self.grid = grid
        self.z_b = self._checked(z_b)
        self._is_own = False
        self.revision = 0
        self._changes: list[tuple[int, Rect]] = []
        self.drawn = self.z_b
        self.outside: npt.NDArray[np.bool_] | None = None
        self.imagery: npt.NDArray[np.uint8] | None = None
        self.cover_revision = 0
        self.z_min = self.z_max = 0.0
        self._lay_apron(outside)
        self.frame = WorldFrame.of_grid(grid, z_ref=self.z_min)

    def cover(self, outside: npt.NDArray[np.bool_] | None, imagery: npt.NDArray[np.uint8] | None) -> None:
        """Say which cells hold no data, and what lies on the ground.

        Args:
            outside: cells without data, shape [nrows, ncols]; None for none.
            imagery: picture that covers the grid, [rows, cols, 3] uint8, row 0 in the south; None for none.

        Raises:
            TerrainDataError: if a shape or type does not fit.
        """
        if imagery is not None and (imagery.ndim != 3 or imagery.shape[2] != 3 or imagery.dtype != np.uint8):
            raise TerrainDataError(
                f"imagery has shape {imagery.shape} and type {imagery.dtype}, [rows, cols, 3] uint8 is needed"
            )
        self._lay_apron(outside)
        self.imagery = imagery
        self.cover_revision += 1

    def set(self, z_b: npt.ArrayLike, dirty: Rect | None = None) -> None:
        """Replace the bed.

        Args:
            z_b: the new bed [m], shape [nrows, ncols].
            dirty: the rectangle outside of which nothing changed; None means everywhere.

        Raises:
            TerrainDataError: as in the constructor.
        """
        self.z_b, self._is_own = self._checked(z_b), False
        nrows, ncols = self.z_b.shape
        self._note_change((0, 0, nrows, ncols) if dirty is None else dirty)

    def set_part(self, rect: Rect, z_b: npt.NDArray[np.float32]) -> None:
        """Replace the bed within a rectangle; an array given to `set` stays as it is.

        Args:
            rect: the rectangle of cells.
            z_b: the bed there [m], float32, shape of the rectangle, finite.
        """
        if not self._is_own:
            self.z_b, self._is_own = self.z_b.copy(), True
        self.z_b[rect[0] : rect[2], rect[1] : rect[3]] = z_b
        self._note_change(rect)

    def _note_change(self, rect: Rect) -> None:
        if rect[2] <= rect[0] or rect[3] <= rect[1]:
            return
        self.revision += 1
        self._changes.append((self.revision, rect))
        del self._changes[:-_HISTORY_LENGTH]
        window = (slice(rect[0], rect[2]), slice(rect[1], rect[3]))
        if self.outside is None:
            self.drawn = self.z_b
        else:
            self.drawn[window] = np.where(self.outside[window], self.drawn[window], self.z_b[window])
        changed = self.drawn[window]
        self.z_min = min(self.z_min, float(changed.min()))
        self.z_max = max(self.z_max, float(changed.max()))

    def changed_since(self, revision: int) -> Rect | None:
        """The rectangle that holds every change made after a revision; None if nothing changed."""
        if revision >= self.revision:
            return None
        later = [rect for number, rect in self._changes if number > revision]
        if len(later) < self.revision - revision:
            return (0, 0, *self.z_b.shape)
        rect: Rect | None = None
        for change in later:
            rect = union_rect(rect, change)
        return rect

    def sample(self, x: Any, y: Any) -> Any:
        """Ground drawn [m, datum-relative], bilinear between cell centres, clamped at the border.

        Args:
            x: easting [m], scalar or array.
            y: northing [m], scalar or array of the same shape.
        """
        nrows, ncols = self.z_b.shape
        grid = self.grid
        col = np.clip((np.asarray(x, dtype=np.float64) - grid.x0) / grid.dx - 0.5, 0.0, ncols - 1.0)
        row = np.clip((np.asarray(y, dtype=np.float64) - grid.y0) / grid.dx - 0.5, 0.0, nrows - 1.0)
        col0 = np.minimum(col.astype(np.int64), max(ncols - 2, 0))
        row0 = np.minimum(row.astype(np.int64), max(nrows - 2, 0))
        col1 = np.minimum(col0 + 1, ncols - 1)
        row1 = np.minimum(row0 + 1, nrows - 1)
        s, t = col - col0, row - row0
        z = self.drawn
        south = z[row0, col0] * (1.0 - s) + z[row0, col1] * s
        north = z[row1, col0] * (1.0 - s) + z[row1, col1] * s
        value = south * (1.0 - t) + north * t
        return float(value) if np.ndim(value) == 0 else value

    def world_height(self, x_world: Any, z_world: Any, frame: WorldFrame | None = None) -> Any:
        """Height of the ground in the world [m] above a world position (scalars or arrays)."""
        frame = self.frame if frame is None else frame
        return frame.height(self.sample(frame.x_centre + x_world, frame.y_centre - z_world))

    def _lay_apron(self, outside: npt.NDArray[np.bool_] | None) -> None:
        if outside is not None and (outside.shape != self.z_b.shape or outside.dtype != np.bool_):
            raise TerrainDataError(
                f"the cells without data have shape {outside.shape} and type {outside.dtype}, "
                f"{self.z_b.shape} bool is needed"
            )
        self.outside = outside if outside is not None and outside.any() and not outside.all() else None
        self.drawn = self.z_b if self.outside is None else continued(self.z_b, self.outside)
        self.z_min = float(self.drawn.min())
        self.z_max = float(self.drawn.max())

    def _checked(self, z_b: npt.ArrayLike) -> npt.NDArray[np.float32]:
        array = np.ascontiguousarray(z_b, dtype=np.float32)
        expected = (self.grid.nrows, self.grid.ncols)
        if array.shape != expected:
            raise TerrainDataError(f"terrain has shape {array.shape}, the grid asks for {expected}")
        if not np.isfinite(array).all():
            raise TerrainDataError(
                "terrain holds elevations that are not finite; fill or wall them off first"
            )
        return array
