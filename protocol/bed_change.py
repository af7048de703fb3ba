"""The bed of a frame where it is not base and edits: the cells that breaches have lowered so far.

Two byte strings of one length, little-endian: the cells as uint32 row x ncols + col, rising, and their bed as
float32 [m, relative to the datum offset].
"""

from __future__ import annotations

import numpy as np

from protocol.blocks import BlockLayout, IntArray
from protocol.depth_codec import FloatArray
from protocol.errors import FrameError
from protocol.limits import MAX_BED_CELLS

BedCells = tuple[IntArray, FloatArray]
"""Cells as row x ncols + col, int64 [k], and their bed [m], float32 [k]."""


def pack_bed(bed: BedCells | None, layout: BlockLayout) -> tuple[bytes, bytes]:
    """Cells and values as bytes; nothing of a bed that nobody lowered.

    Raises:
        FrameError: when `unpack_bed` would refuse them.
    """
    if bed is None:
        return b"", b""
    cells, values = np.asarray(bed[0], np.int64), np.asarray(bed[1], np.float32)
    _check(cells, values, layout)
    return cells.astype("<u4").tobytes(), values.astype("<f4").tobytes()


def unpack_bed(cells: bytes, values: bytes, layout: BlockLayout) -> BedCells:
    """Cells and values from their bytes.

    Raises:
        FrameError: when the two differ in length, a cell is off the grid or out of order, or a value is not
            finite.
    """
    if len(cells) % 4 or len(values) % 4:
        raise FrameError(f"A bed has {len(cells)} and {len(values)} bytes; multiples of 4 are allowed.")
    places = np.frombuffer(cells, dtype="<u4").astype(np.int64)
    heights = np.frombuffer(values, dtype="<f4").astype(np.float32)
    _check(places, heights, layout)
    return places, heights


def _check(cells: IntArray, values: FloatArray, layout: BlockLayout) -> None:
    if cells.ndim != 1 or cells.shape != values.shape or cells.size > MAX_BED_CELLS:
        raise FrameError(
            f"A bed has {cells.size} cells and {values.size} values; as many of both, up to {MAX_BED_CELLS},"
            " are allowed."
        )
    if not cells.size:
        return
    count = layout.nrows * layout.ncols
    if cells[0] < 0 or cells[-1] >= count or (np.diff(cells) <= 0).any():
        raise FrameError(f"The cells of a bed do not rise from 0 to {count - 1} at most.")
    if not np.isfinite(values).all():
        raise FrameError("A bed holds elevations that are not finite.")
