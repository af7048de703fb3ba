"""How a raster is cut into level-of-detail blocks of (2^n + 1)^2 vertices that share their edges.

A raster whose size fits no blocks has ragged ones at its north and east border, or is trimmed or padded as
in the FEV frontend (Sharrow 2011, section 3.1.3).
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from functools import cached_property
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt

__all__ = ["BLOCK_SIZES", "BlockTiling", "Border", "classify_blocks"]

BLOCK_SIZES = (17, 33, 65)

_Scalar = TypeVar("_Scalar", bound=np.generic)


class Border(Enum):
    """What is done with rows and columns that fill no whole block."""

    RAGGED = "ragged"
    """A vertex past the border is moved onto it: all cells are drawn, triangles past the border have no
    area."""
    TRIM = "trim"
    """They are not drawn; a raster smaller than one block stays whole."""
    PAD = "pad"
    """Whole blocks are drawn, with level ground past the border that is marked as no data."""


@dataclass(frozen=True)
class BlockTiling:
    """Blocks over a raster, in row-major order from the south-west.

    Raises:
        ValueError: if the raster has fewer than 2 rows or columns or the block size is not 17, 33 or 65.
    """

    nrows: int
    """Rows of the raster."""
    ncols: int
    """Columns of the raster."""
    block_size: int = 33
    """Vertices along a block's side."""
    border: Border = Border.RAGGED

    def __post_init__(self) -> None:
        """Check the sizes."""
        if self.nrows < 2 or self.ncols < 2:
            raise ValueError(
                f"a terrain of {self.nrows} x {self.ncols} vertices has no triangle; 2 x 2 is the least"
            )
        if self.block_size not in BLOCK_SIZES:
            raise ValueError(f"block size {self.block_size} is not one of {BLOCK_SIZES}")

    @property
    def stride(self) -> int:
        """Cells along a block's side."""
        return self.block_size - 1

    @property
    def level_count(self) -> int:
        """Levels of detail; level l uses every 2^l-th vertex."""
        return self.stride.bit_length()

    @property
    def block_rows(self) -> int:
        """Blocks from south to north."""
        return self._blocks_along(self.nrows)

    @property
    def block_cols(self) -> int:
        """Blocks from west to east."""
        return self._blocks_along(self.ncols)

    @property
    def block_count(self) -> int:
        """Blocks in all."""
        return self.block_rows * self.block_cols

    @property
    def drawn_rows(self) -> int:
        """Rows of vertices that the blocks draw: fewer than the raster's where trimmed, more where padded."""
        return self._drawn_along(self.nrows)

    @property
    def drawn_cols(self) -> int:
        """Columns of vertices that the blocks draw."""
        return self._drawn_along(self.ncols)

    @cached_property
    def drawn(self) -> BlockTiling:
        """The same blocks over the raster as it is drawn."""
        return BlockTiling(self.drawn_rows, self.drawn_cols, self.block_size)

    @cached_property
    def row_start(self) -> npt.NDArray[np.int64]:
        """First vertex row of each block row."""
        return np.arange(self.block_rows) * self.stride

    @cached_property
    def row_end(self) -> npt.NDArray[np.int64]:
        """Last vertex row of each block row (shared with the next block)."""
        return np.minimum(self.row_start + self.stride, self.drawn_rows - 1)

    @cached_property
    def col_start(self) -> npt.NDArray[np.int64]:
        """First vertex column of each block column."""
        return np.arange(self.block_cols) * self.stride

    @cached_property
    def col_end(self) -> npt.NDArray[np.int64]:
        """Last vertex column of each block column (shared with the next block)."""
        return np.minimum(self.col_start + self.stride, self.drawn_cols - 1)

    @cached_property
    def triangle_counts(self) -> npt.NDArray[np.int64]:
        """Triangles with an area at each level of each block, shape [level_count, block_count].

        Edges fitted to a coarser neighbour leave out more; see `Selection`.
        """
        counts = []
        for level in range(self.level_count):
            step = 1 << level
            rows = -(-(self.row_end - self.row_start) // step)
            cols = -(-(self.col_end - self.col_start) // step)
            counts.append((2 * rows[:, None] * cols[None, :]).ravel())
        return np.stack(counts)

    def fitted(self, values: npt.NDArray[_Scalar]) -> npt.NDArray[_Scalar]:
        """The raster as the blocks draw it: cut off where trimmed, its last values repeated where padded.

        Args:
            values: shape [nrows, ncols].

        Returns:
            shape [drawn_rows, drawn_cols]; the same array where nothing changes.
        """
        part = values[: self.drawn_rows, : self.drawn_cols]
        more = (self.drawn_rows - part.shape[0], self.drawn_cols - part.shape[1])
        return np.pad(part, ((0, more[0]), (0, more[1])), mode="edge") if any(more) else part

    def reduce(self, ufunc: np.ufunc, values: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """Reduce an array over the vertices of each block, shared edges included.

        Args:
            ufunc: an idempotent function such as np.maximum.
            values: shape [nrows, ncols].

        Returns:
            shape [block_rows, block_cols].
        """
        values = self.fitted(values)
        by_row = ufunc(ufunc.reduceat(values, self.row_start, axis=0), values[self.row_end])
        return np.asarray(ufunc(ufunc.reduceat(by_row, self.col_start, axis=1), by_row[:, self.col_end]))

    def blocks_touching(self, rect: tuple[int, int, int, int]) -> tuple[int, int, int, int]:
        """Blocks that hold a vertex of a rectangle of cells.

        Args:
            rect: first row, first column, end row, end column.

        Returns:
            first block row, first block column, end block row, end block column.
        """
        row0, col0, row1, col1 = rect
        # A vertex on a shared edge belongs to the block before as well.
        return (
            max(0, -(-row0 // self.stride) - 1),
            max(0, -(-col0 // self.stride) - 1),
            min(self.block_rows, (row1 - 1) // self.stride + 1),
            min(self.block_cols, (col1 - 1) // self.stride + 1),
        )

    def _blocks_along(self, count: int) -> int:
        whole, rest = divmod(count - 1, self.stride)
        return max(1, whole if self.border is Border.TRIM or not rest else whole + 1)

    def _drawn_along(self, count: int) -> int:
        reach = self._blocks_along(count) * self.stride + 1
        return reach if self.border is Border.PAD else min(reach, count)


def classify_blocks(h: npt.NDArray[np.float32], tiling: BlockTiling) -> npt.NDArray[np.uint8]:
    """Block states of a depth raster: 0 dry (no vertex wet), 2 wet (all wet), else 1 partial.

    Args:
        h: depth [m], shape [nrows, ncols]; wet means > 0.
        tiling: the blocks.

    Returns:
        shape [block_rows, block_cols].
    """
    is_wet = h > 0.0
    any_wet = tiling.reduce(np.logical_or, is_wet)
    all_wet = tiling.reduce(np.logical_and, is_wet)
    return any_wet.astype(np.uint8) + all_wet.astype(np.uint8)
