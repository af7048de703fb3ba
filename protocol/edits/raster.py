"""Which cells an edit covers, and where along the line each lies.

Vertices are rounded to 1/1024 of a cell once; from there on everything that decides whether a cell is covered
is integer arithmetic, so that two machines never disagree. In these units a cell centre is (1024 col + 512,
1024 row + 512). A cell belongs to a line if its centre P is within r, half the width, of a segment AB:

    d = B - A,  t = (P - A) . d,  L2 = d . d
    t <= 0:   |P - A|^2 <= r^2          t >= L2:   |P - B|^2 <= r^2
    else:     ((P - A) x d)^2 <= r^2 L2

plus the Bresenham cells of the segment, so that a thin line has no gaps. A cell belongs to an area if its
centre is inside by the even-odd rule; a centre on a western or southern side is inside.
"""

from __future__ import annotations

from math import isqrt

import numpy as np
import numpy.typing as npt

from protocol.edits.model import Edit, EditArea, EditLine
from protocol.errors import EditError
from protocol.grid import GridGeometry
from protocol.limits import MAX_EDIT_WORK

SUBCELLS = 1024
"""Units in a cell."""

HALF = SUBCELLS // 2

Int32Array = npt.NDArray[np.int32]
Int64Array = npt.NDArray[np.int64]
Float64Array = npt.NDArray[np.float64]


def rasterise_edit(edit: Edit, grid: GridGeometry) -> tuple[Int32Array, Int32Array, Float64Array | None]:
    """Cells that an edit covers, each once, sorted by row, then column.

    Args:
        edit: the edit.
        grid: the grid it is drawn on.

    Returns:
        Rows, columns and, for a line, the position of the nearest point of the line: vertex number plus
        fraction of the segment that follows (2.25 is a quarter past vertex 2); none for an area.

    Raises:
        EditError: when a vertex is outside the grid, or more than `MAX_EDIT_WORK` cells would be looked at.
    """
    if isinstance(edit, EditArea):
        rows, cols = _rasterise_area(edit, grid)
        return rows, cols, None
    return _rasterise_line(edit, grid)


def to_units(edit: Edit, grid: GridGeometry) -> tuple[Int64Array, Int64Array]:
    """Vertices (x, y) in 1/1024 of a cell from the grid's corner.

    Raises:
        EditError: when a vertex is outside the grid.
    """
    points = np.array(edit.vertices, dtype=np.float64)
    xmin, ymin, xmax, ymax = grid.extent
    # Written so that a vertex that is not a number counts as outside.
    inside = (points >= (xmin, ymin)).all(axis=1) & (points <= (xmax, ymax)).all(axis=1)
    if not inside.all():
        number = int(np.argmin(inside))
        raise EditError(
            f"Edit {edit.id!r} vertex {number} is at ({points[number, 0]:g}, {points[number, 1]:g}), outside"
            f" the terrain; x from {xmin:g} to {xmax:g} and y from {ymin:g} to {ymax:g} is allowed."
        )
    x = np.rint((points[:, 0] - grid.x0) / grid.dx * SUBCELLS)
    y = np.rint((points[:, 1] - grid.y0) / grid.dx * SUBCELLS)
    return x.astype(np.int64), y.astype(np.int64)


def _ranges(counts: Int64Array) -> tuple[Int64Array, Int64Array]:
    """For counts (2, 3): owner (0, 0, 1, 1, 1) and position within the owner (0, 1, 0, 1, 2)."""
    owner = np.repeat(np.arange(counts.size), counts)
    starts = np.cumsum(counts) - counts
    return owner, np.arange(owner.size) - starts[owner]


def _rasterise_line(edit: EditLine, grid: GridGeometry) -> tuple[Int32Array, Int32Array, Float64Array]:
    x, y = to_units(edit, grid)
    # Wider than twice round the grid changes nothing and would overflow.
    width = round(min(edit.width / grid.dx, 2.0 * (grid.nrows + grid.ncols)) * SUBCELLS)
    ax, ay, bx, by = x[:-1], y[:-1], x[1:], y[1:]
    thick = _capsule_cells(edit, grid, width, ax, ay, bx, by)
    thin = _bresenham_cells(grid, ax, ay, bx, by)
    segment, row, col = (np.concatenate(pair) for pair in zip(thick, thin, strict=True))

    px, py = col * SUBCELLS + HALF - ax[segment], row * SUBCELLS + HALF - ay[segment]
    dx, dy = (bx - ax)[segment], (by - ay)[segment]
    length2 = dx * dx + dy * dy
    along = np.clip(px * dx + py * dy, 0, length2) / np.maximum(length2, 1)
    distance2 = (px - along * dx) ** 2 + (py - along * dy) ** 2
    # The nearest segment counts; the earlier one where two are as near.
    cell = row * grid.ncols + col
    order = np.lexsort((segment, distance2, cell))
    cell = cell[order]
    first = np.ones(cell.size, dtype=bool)
    first[1:] = cell[1:] != cell[:-1]
    chosen = order[first]
    position = segment[chosen] + along[chosen]
    return row[chosen].astype(np.int32), col[chosen].astype(np.int32), position


def _capsule_cells(
    edit: EditLine,
    grid: GridGeometry,
    width: int,
    ax: Int64Array,
    ay: Int64Array,
    bx: Int64Array,
    by: Int64Array,
) -> tuple[Int64Array, Int64Array, Int64Array]:
    """Segment, row and column of every cell whose centre is within half the width of a segment."""
    radius = width // 2 + 1
    row_first = np.maximum((np.minimum(ay, by) - radius - HALF) // SUBCELLS, 0)
    row_last = np.minimum((np.maximum(ay, by) + radius - HALF) // SUBCELLS + 1, grid.nrows - 1)
    row_counts = np.maximum(row_last - row_first + 1, 0)
    _check_work(edit, int(row_counts.sum()))
    segment, offset = _ranges(row_counts)
    row = row_first[segment] + offset

    # The part of the segment in the band |y - centre| <= radius bounds the columns of a row.
    dx, dy = (bx - ax)[segment], (by - ay)[segment]
    centre = row * SUBCELLS + HALF - ay[segment]
    slope = np.where(dy == 0, 1, dy).astype(np.float64)
    t0 = np.where(dy == 0, 0.0, np.clip((centre - radius) / slope, 0.0, 1.0))
    t1 = np.where(dy == 0, 1.0, np.clip((centre + radius) / slope, 0.0, 1.0))
    x0, x1 = ax[segment] + t0 * dx, ax[segment] + t1 * dx
    col_first = np.floor((np.minimum(x0, x1) - radius - HALF) / SUBCELLS).astype(np.int64)
    col_last = np.ceil((np.maximum(x0, x1) + radius - HALF) / SUBCELLS).astype(np.int64)
    col_first = np.maximum(col_first, 0)
    col_last = np.minimum(col_last, grid.ncols - 1)
    col_counts = np.maximum(col_last - col_first + 1, 0)
    _check_work(edit, int(col_counts.sum()))
    span, offset = _ranges(col_counts)
    segment, row, col = segment[span], row[span], col_first[span] + offset

    px, py = col * SUBCELLS + HALF - ax[segment], row * SUBCELLS + HALF - ay[segment]
    dx, dy = dx[span], dy[span]
    length2 = dx * dx + dy * dy
    t = px * dx + py * dy
    # Twice the distance against the width keeps halves out; isqrt keeps the squares within 64 bits.
    limits = np.array(
        [isqrt(width * width * (int(u) ** 2 + int(v) ** 2)) for u, v in zip(bx - ax, by - ay, strict=True)],
        dtype=np.int64,
    )
    at_a = 4 * (px * px + py * py) <= width * width
    qx, qy = px - dx, py - dy
    at_b = 4 * (qx * qx + qy * qy) <= width * width
    beside = 2 * np.abs(px * dy - py * dx) <= limits[segment]
    covered = np.where(t <= 0, at_a, np.where(t >= length2, at_b, beside))
    return segment[covered], row[covered], col[covered]


def _bresenham_cells(
    grid: GridGeometry, ax: Int64Array, ay: Int64Array, bx: Int64Array, by: Int64Array
) -> tuple[Int64Array, Int64Array, Int64Array]:
    """Segment, row and column of the Bresenham cells from the cell of A to the cell of B.

    A vertex on the northern or eastern edge of the grid is in the last row or column.
    """
    col0, col1 = (np.minimum(x // SUBCELLS, grid.ncols - 1) for x in (ax, bx))
    row0, row1 = (np.minimum(y // SUBCELLS, grid.nrows - 1) for y in (ay, by))
    dcol, drow = col1 - col0, row1 - row0
    steps = np.maximum(np.abs(dcol), np.abs(drow))
    segment, i = _ranges(steps + 1)
    steps = np.maximum(steps[segment], 1)
    col = col0[segment] + np.sign(dcol[segment]) * ((2 * i * np.abs(dcol[segment]) + steps) // (2 * steps))
    row = row0[segment] + np.sign(drow[segment]) * ((2 * i * np.abs(drow[segment]) + steps) // (2 * steps))
    return segment, row, col


def _rasterise_area(edit: EditArea, grid: GridGeometry) -> tuple[Int32Array, Int32Array]:
    x, y = to_units(edit, grid)
    swap = y > np.roll(y, -1)
    ax, bx = np.where(swap, np.roll(x, -1), x), np.where(swap, x, np.roll(x, -1))
    ay, by = np.where(swap, np.roll(y, -1), y), np.where(swap, y, np.roll(y, -1))
    # Rows whose centre line crosses an edge: ay <= centre < by.
    row_first = np.clip(-((HALF - ay) // SUBCELLS), 0, grid.nrows)
    row_end = np.clip(-((HALF - by) // SUBCELLS), 0, grid.nrows)
    counts = row_end - row_first
    top, bottom = int(row_end.max()), int(row_first.min())
    left, right = int(x.min()) // SUBCELLS, min(int(x.max()) // SUBCELLS + 1, grid.ncols)
    _check_work(edit, int(counts.sum()))
    edge, offset = _ranges(counts)
    row = row_first[edge] + offset
    # First column whose centre is not west of the crossing, by exact division.
    dy = by[edge] - ay[edge]
    numerator = (ax[edge] - HALF) * dy + (row * SUBCELLS + HALF - ay[edge]) * (bx[edge] - ax[edge])
    col = np.clip(-((-numerator) // (SUBCELLS * dy)), left, right)
    toggles = np.zeros((top - bottom, right - left + 1), dtype=np.int32)
    np.add.at(toggles, (row - bottom, col - left), 1)
    inside = np.cumsum(toggles[:, :-1], axis=1) % 2 == 1
    rows, cols = np.nonzero(inside)
    return (rows + bottom).astype(np.int32), (cols + left).astype(np.int32)


def _check_work(edit: Edit, candidates: int) -> None:
    if candidates > MAX_EDIT_WORK:
        raise EditError(
            f"Edit {edit.id!r} needs {candidates} cells looked at; up to {MAX_EDIT_WORK} are allowed:"
            " draw it narrower or with fewer vertices."
        )
