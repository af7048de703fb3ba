"""Finds the blocks that may be in view by going down a quadtree of bounding spheres.

As in the FEV frontend (Sharrow 2011, sections 3.1.2 and 4).
The tree is as wide as the next power of two of the longer side; nodes without a block end the way down. A
depth of the tree is looked at in one go, so the cost grows with the border of the view and not with the map.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from viewer.lod.block_errors import BlockBounds
from viewer.lod.block_tiling import BlockTiling
from viewer.world.coordinates import WorldFrame
from viewer.world.frustum import Frustum

__all__ = ["BlockQuadtree"]

Indices = npt.NDArray[np.int64]
Array = npt.NDArray[np.float64]

_SLACK = 1e-5
"""What a sphere is wider than it need be, as a share of the map: boxes are tested in single precision."""


class BlockQuadtree:
    """A quadtree whose leaves are the blocks of one terrain."""

    def __init__(self, tiling: BlockTiling, dx: float, bounds: BlockBounds) -> None:
        """Lay the nodes out.

        Args:
            tiling: the blocks.
            dx: cell size [m].
            bounds: lowest and highest ground of each block [m, datum-relative].
        """
        self._shape = (tiling.block_rows, tiling.block_cols)
        self._depth = (max(self._shape) - 1).bit_length()
        self._bounds = bounds
        middle_row, middle_col = 0.5 * (tiling.nrows - 1), 0.5 * (tiling.ncols - 1)
        # Per depth: middles and half lengths along a row of nodes [m], and along a column.
        self._columns: list[tuple[Array, Array]] = []
        self._rows: list[tuple[Array, Array]] = []
        for depth in range(self._depth + 1):
            size = self._leaves_along(depth)
            self._columns.append(_intervals(tiling.col_start, tiling.col_end, size, middle_col, dx))
            self._rows.append(_intervals(tiling.row_start, tiling.row_end, size, middle_row, dx))
        self._slack = _SLACK * dx * max(tiling.drawn_rows, tiling.drawn_cols)
        self._z_min: list[npt.NDArray[np.float32]] = []
        self._z_max: list[npt.NDArray[np.float32]] = []
        self.refresh()

    def refresh(self) -> None:
        """Take over bounds that have changed."""
        self._z_min, self._z_max = [self._bounds.z_min], [self._bounds.z_max]
        for _ in range(self._depth):
            self._z_min.insert(0, _halved(np.minimum, self._z_min[0]))
            self._z_max.insert(0, _halved(np.maximum, self._z_max[0]))

    def candidates(self, frustum: Frustum, frame: WorldFrame, water_height: float = 0.0) -> Indices:
        """Blocks whose bounding sphere meets the view, and those of nodes that lie within it.

        Args:
            frustum: the view.
            frame: world frame with the vertical exaggeration drawn.
            water_height: how far water may reach above the highest ground anywhere [m].

        Returns:
            block numbers, in no order; every block with a point in view is among them.
        """
        normals, offsets = frustum.planes[:, :3], frustum.planes[:, 3:]
        rows = cols = np.zeros(1, dtype=np.int64)
        found: list[Indices] = []
        for depth in range(self._depth + 1):
            (x, half_x), (y, half_y) = self._columns[depth], self._rows[depth]
            low = frame.height(self._z_min[depth][rows, cols].astype(np.float64))
            high = frame.height(self._z_max[depth][rows, cols].astype(np.float64)) + water_height
            centre = np.stack([x[cols], 0.5 * (low + high), -y[rows]])
            radius = np.sqrt(half_x[cols] ** 2 + half_y[rows] ** 2 + (0.5 * (high - low)) ** 2) + self._slack
            nearest = (normals @ centre + offsets).min(axis=0)
            within = nearest >= radius
            if depth == self._depth:
                within = nearest >= -radius
            found.append(self._leaves(rows[within], cols[within], depth))
            if depth == self._depth:
                break
            cut = ~within & (nearest >= -radius)
            rows, cols = self._children(rows[cut], cols[cut], depth)
        return np.concatenate(found)

    def _leaves_along(self, depth: int) -> int:
        return 1 << (self._depth - depth)

    def _children(self, rows: Indices, cols: Indices, depth: int) -> tuple[Indices, Indices]:
        """The four children of each node, less those without a block."""
        rows = (2 * rows[:, None] + np.array([0, 0, 1, 1])).ravel()
        cols = (2 * cols[:, None] + np.array([0, 1, 0, 1])).ravel()
        has_data = (rows < self._rows[depth + 1][0].size) & (cols < self._columns[depth + 1][0].size)
        return rows[has_data], cols[has_data]

    def _leaves(self, rows: Indices, cols: Indices, depth: int) -> Indices:
        """Numbers of all blocks below some nodes."""
        along = np.arange(self._leaves_along(depth))
        row = rows[:, None, None] * along.size + along[:, None]
        col = cols[:, None, None] * along.size + along
        has_data = (row < self._shape[0]) & (col < self._shape[1])
        return np.asarray((row * self._shape[1] + col)[has_data])


def _intervals(start: Indices, end: Indices, size: int, middle: float, dx: float) -> tuple[Array, Array]:
    """Middle and half length [m] of runs of `size` blocks, measured from the middle of the raster."""
    first = start[::size]
    last = end[np.minimum(np.arange(first.size) * size + size, end.size) - 1]
    return (0.5 * (first + last) - middle) * dx, 0.5 * (last - first) * dx


def _halved(ufunc: np.ufunc, values: npt.NDArray[np.float32]) -> npt.NDArray[np.float32]:
    """Each two by two values reduced to one; a last odd row or column stands for itself."""
    rows = ufunc.reduceat(values, np.arange(0, values.shape[0], 2), axis=0)
    return np.asarray(ufunc.reduceat(rows, np.arange(0, values.shape[1], 2), axis=1))
