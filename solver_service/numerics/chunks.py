"""The active tiles of a grid as rectangles of cells for the row loops.

Tiles that lie side by side in a row of tiles make one rectangle, split where it is wider than the cache
likes; equal rectangles of consecutive tile rows are stacked, but not higher than a thread's fair share, so
that the threads can be dealt equal work.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from solver_service.numerics.fields import TILE


def _spans(mask: npt.NDArray[np.bool_], ncols: int, widest: int) -> dict[int, list[tuple[int, int]]]:
    """Column ranges [first, last) of the runs of active tiles, by row of tiles."""
    padded = np.zeros((mask.shape[0], mask.shape[1] + 2), np.int8)
    padded[:, 1:-1] = mask
    change = np.diff(padded, axis=1)
    rows, begins = np.nonzero(change == 1)
    ends = np.nonzero(change == -1)[1]
    spans: dict[int, list[tuple[int, int]]] = {}
    for row, begin, end in zip(rows.tolist(), begins.tolist(), ends.tolist(), strict=True):
        first, last = begin * TILE, min(end * TILE, ncols)
        pieces = -(-(last - first) // widest)
        width = -(-(last - first) // (pieces * TILE)) * TILE
        cuts = [(col, min(col + width, last)) for col in range(first, last, width)]
        spans.setdefault(row, []).extend(cuts)
    return spans


def cut_chunks(
    mask: npt.NDArray[np.bool_], nrows: int, ncols: int, threads: int, widest: int
) -> npt.NDArray[np.int32]:
    """Rectangles that cover exactly the active tiles.

    Args:
        mask: active tiles, [tile rows, tile columns].
        nrows: grid rows.
        ncols: grid columns.
        threads: threads that share the work.
        widest: most columns of a rectangle, a multiple of the tile side.

    Returns:
        First row, one past the last row, first column, one past the last column; [chunks, 4].
    """
    highest = max(1, -(-mask.shape[0] // (8 * threads)))
    chunks: list[list[int]] = []
    growing: dict[tuple[int, int], list[int]] = {}
    spans = _spans(mask, ncols, widest)
    for tile_row in range(mask.shape[0]):
        row0, row1 = tile_row * TILE, min((tile_row + 1) * TILE, nrows)
        now: dict[tuple[int, int], list[int]] = {}
        for span in spans.get(tile_row, ()):
            chunk = growing.get(span)
            if chunk is None or row0 - chunk[0] >= highest * TILE:
                chunk = [row0, row1, *span]
                chunks.append(chunk)
            chunk[1] = row1
            now[span] = chunk
        growing = now
    return np.array(sorted(chunks), np.int32).reshape(-1, 4)


def deal_chunks(chunks: npt.NDArray[np.int32], threads: int) -> npt.NDArray[np.int32]:
    """First chunk of each thread's share, and one past the last; shares have about equal numbers of cells.

    Returns:
        [threads + 1], never falling.
    """
    reached = np.cumsum((chunks[:, 1] - chunks[:, 0]) * (chunks[:, 3] - chunks[:, 2]))
    bounds = np.full(threads + 1, len(chunks), np.int32)
    bounds[0] = 0
    if reached.size:
        bounds[1:-1] = np.searchsorted(reached, reached[-1] * np.arange(1, threads) / threads)
    return bounds
