"""Output blocks: the grid cut into squares of 33 x 33 vertices that share their edges.

Block (i, j) spans the rows 32 i .. min(32 (i + 1), nrows - 1) and the same for columns, both ends included,
so that it can be drawn without its neighbours. Each cell has one owner, block min(row // 32, block_rows - 1),
so that it is sent once. The last block of a ragged side is smaller.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import IntEnum
from functools import cached_property
from typing import TypeVar

import numpy as np
import numpy.typing as npt

from protocol.errors import FrameError

BLOCK_STRIDE = 32
"""Cells from one block to the next."""

BoolArray = npt.NDArray[np.bool_]
UInt8Array = npt.NDArray[np.uint8]
UInt16Array = npt.NDArray[np.uint16]
IntArray = npt.NDArray[np.int64]
Scalar = TypeVar("Scalar", bound=np.generic)


class BlockState(IntEnum):
    """How many of a block's vertices carry water."""

    DRY = 0
    PARTIAL = 1
    WET = 2


def _block_count(vertex_count: int) -> int:
    return max(1, -(-(vertex_count - 1) // BLOCK_STRIDE))


@dataclass(frozen=True)
class BlockLayout:
    """The blocks of a grid of nrows x ncols vertices."""

    nrows: int
    ncols: int

    @cached_property
    def block_rows(self) -> int:
        """Blocks from south to north."""
        return _block_count(self.nrows)

    @cached_property
    def block_cols(self) -> int:
        """Blocks from west to east."""
        return _block_count(self.ncols)

    @property
    def block_count(self) -> int:
        """Number of blocks."""
        return self.block_rows * self.block_cols

    @property
    def shape(self) -> tuple[int, int]:
        """Shape (block_rows, block_cols) of a state array."""
        return (self.block_rows, self.block_cols)

    @cached_property
    def row_owner(self) -> IntArray:
        """Block row that owns each row, shape [nrows]."""
        return np.minimum(np.arange(self.nrows) // BLOCK_STRIDE, self.block_rows - 1)

    @cached_property
    def col_owner(self) -> IntArray:
        """Block column that owns each column, shape [ncols]."""
        return np.minimum(np.arange(self.ncols) // BLOCK_STRIDE, self.block_cols - 1)

    def classify(self, q: UInt16Array) -> UInt8Array:
        """State of each block from all its vertices, shared edges included.

        Args:
            q: quantised depth, shape [nrows, ncols]; above 0 is wet.

        Returns:
            `BlockState` values, shape [block_rows, block_cols].
        """
        if q.shape != (self.nrows, self.ncols):
            raise FrameError(f"Depths have the shape {q.shape}; {(self.nrows, self.ncols)} is allowed.")
        # One bit a vertex, one 32-bit word a block and row: 32 columns are then one bitwise operation.
        word_count = -(-self.ncols // BLOCK_STRIDE)
        bits = np.zeros((self.nrows, 4 * word_count), dtype=np.uint8)
        packed = np.packbits(q > 0, axis=1, bitorder="little")
        bits[:, : packed.shape[1]] = packed
        words = bits.view("<u4")
        any_wet = self._combine(np.bitwise_or, words, word_count)
        tail_bits = self.ncols - BLOCK_STRIDE * (word_count - 1)
        if tail_bits < BLOCK_STRIDE:
            words[:, -1] |= np.uint32((0xFFFFFFFF << tail_bits) & 0xFFFFFFFF)
        all_wet = self._combine(np.bitwise_and, words, word_count)
        some = any_wet != 0
        full = all_wet == 0xFFFFFFFF
        states: UInt8Array = some.astype(np.uint8) + full.astype(np.uint8)
        return states

    def _combine(
        self, operation: np.ufunc, words: npt.NDArray[np.uint32], word_count: int
    ) -> npt.NDArray[np.uint32]:
        """Reduce words over the rows and the shared edge column of each block."""
        starts = np.arange(self.block_rows) * BLOCK_STRIDE
        rows = operation.reduceat(words, starts, axis=0)
        rows[:-1] = operation(rows[:-1], words[starts[1:]])
        blocks = rows[:, : self.block_cols].copy()
        # A block's eastern edge is bit 0 of the next word, spread so that it counts as all or none.
        edge = np.where(rows[:, 1:word_count] & 1, np.uint32(0xFFFFFFFF), np.uint32(0))
        blocks[:, : word_count - 1] = operation(blocks[:, : word_count - 1], edge)
        return blocks

    def owned_mask(self, states: npt.ArrayLike) -> BoolArray:
        """Cells whose owner block is not DRY, shape [nrows, ncols]: those a frame carries."""
        active = np.asarray(states).reshape(self.shape) != BlockState.DRY
        return np.asarray(np.repeat(np.repeat(active, self._col_counts, axis=1), self._row_counts, axis=0))

    def owned_count(self, states: npt.ArrayLike) -> int:
        """Number of cells whose owner block is not DRY."""
        active = np.asarray(states).reshape(self.shape) != BlockState.DRY
        return int((active * self._row_counts[:, None] * self._col_counts).sum())

    def gather(self, raster: npt.NDArray[Scalar], states: npt.ArrayLike) -> npt.NDArray[Scalar]:
        """The values of the cells that `owned_mask` names, in row-major order, shape [owned_count]."""
        cells = np.empty(self.owned_count(states), raster.dtype)
        for part, rows, columns in self._stretches(cells, states):
            part[...] = raster[rows, columns]
        return cells

    def scatter(self, cells: npt.NDArray[Scalar], states: npt.ArrayLike, raster: npt.NDArray[Scalar]) -> None:
        """Put gathered values back into a raster; its other cells stay as they are."""
        for part, rows, columns in self._stretches(cells, states):
            raster[rows, columns] = part

    def _stretches(
        self, cells: npt.NDArray[Scalar], states: npt.ArrayLike
    ) -> Iterator[tuple[npt.NDArray[Scalar], slice, slice]]:
        """Views of gathered cells, each a rectangle of the grid: side by side blocks that are not DRY."""
        active = np.asarray(states).reshape(self.shape) != BlockState.DRY
        edges = np.diff(active, axis=1, prepend=False, append=False)
        starts = np.append(0, np.cumsum(self._col_counts)).tolist()
        row = offset = 0
        for block_row, row_count in enumerate(self._row_counts.tolist()):
            turns = [starts[block_col] for block_col in np.flatnonzero(edges[block_row]).tolist()]
            width = sum(turns[1::2]) - sum(turns[::2])
            band = cells[offset : offset + row_count * width].reshape(row_count, width)
            column = 0
            for west, east in zip(turns[::2], turns[1::2], strict=True):
                yield band[:, column : column + east - west], slice(row, row + row_count), slice(west, east)
                column += east - west
            row += row_count
            offset += band.size

    @cached_property
    def _row_counts(self) -> IntArray:
        return np.bincount(self.row_owner, minlength=self.block_rows)

    @cached_property
    def _col_counts(self) -> IntArray:
        return np.bincount(self.col_owner, minlength=self.block_cols)

    @property
    def packed_size(self) -> int:
        """Bytes of the packed states."""
        return -(-self.block_count // 4)

    def pack_states(self, states: npt.ArrayLike) -> bytes:
        """Two bits a block, row-major: block k in the bits 2 (k % 4) and up of byte k // 4."""
        padded = np.zeros(4 * self.packed_size, dtype=np.uint8)
        padded[: self.block_count] = np.asarray(states, dtype=np.uint8).reshape(-1)
        quads = padded.reshape(-1, 4)
        return (quads[:, 0] | quads[:, 1] << 2 | quads[:, 2] << 4 | quads[:, 3] << 6).tobytes()

    def unpack_states(self, packed: bytes) -> UInt8Array:
        """States of all blocks, shape [block_rows, block_cols].

        Raises:
            FrameError: when the length does not fit the layout, a state is 3 or a padding bit is set.
        """
        if len(packed) != self.packed_size:
            raise FrameError(f"Block states take {len(packed)} bytes; {self.packed_size} are allowed.")
        quads = np.frombuffer(packed, dtype=np.uint8)
        states = (quads[:, None] >> np.array([0, 2, 4, 6], dtype=np.uint8) & 3).reshape(-1)
        if states.max(initial=0) > BlockState.WET or states[self.block_count :].any():
            raise FrameError("Block states hold the value 3 or padding that is not 0; 0 to 2 is allowed.")
        return np.ascontiguousarray(states[: self.block_count]).reshape(self.shape)
