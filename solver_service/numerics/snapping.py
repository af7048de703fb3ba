"""Lines and points of structures on the grid: which cells and which faces they take.

Lines have vertices (column, row) in cells from the centre of cell (0, 0), as gauges do. A line becomes a
chain of faces, a staircase of sides of cells without gap, so that what stands on it parts the cells on its
two sides; or a strip of cells.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from solver_service.errors import ModelError

Vertices = tuple[tuple[float, float], ...]
Cells = tuple[tuple[int, int], ...]
IntArray = npt.NDArray[np.int32]
RealArray = npt.NDArray[np.float64]

EAST_FACE = 0
NORTH_FACE = 1


@dataclass(frozen=True)
class Snapped:
    """What a structure took of the grid, for display."""

    cells: IntArray
    """Row and column of each cell, [cells, 2]."""
    faces: IntArray
    """Row, column and side, 0 the eastern face of that cell and 1 the northern, [faces, 3]."""

    def face_lines(self) -> RealArray:
        """Both ends of each face as (column, row) from the centre of cell (0, 0), [faces, 2, 2]."""
        row, col = self.faces[:, 0].astype(np.float64), self.faces[:, 1].astype(np.float64)
        northern = self.faces[:, 2] == NORTH_FACE
        begin = np.stack(
            [np.where(northern, col - 0.5, col + 0.5), np.where(northern, row + 0.5, row - 0.5)], 1
        )
        return np.stack([begin, np.stack([col + 0.5, row + 0.5], 1)], 1)


NO_CELLS = np.zeros((0, 2), np.int32)
NO_FACES = np.zeros((0, 3), np.int32)


@dataclass(frozen=True)
class NearestOnLine:
    """For points, the nearest place on a polyline."""

    distance: RealArray
    """To the line [cells]."""
    along: RealArray
    """Length of the line up to the place [cells]."""
    segment: npt.NDArray[np.int64]
    """Segment of the place."""
    fraction: RealArray
    """Where on the segment, 0 to 1."""


def sentence(what: str) -> str:
    """The text with a capital letter at its beginning."""
    return what[:1].upper() + what[1:]


def check_vertices(what: str, vertices: Vertices) -> Vertices:
    """The vertices as floats.

    Raises:
        ModelError: when there are not two, or one is not finite, or two that follow each other are equal.
    """
    points = tuple((float(col), float(row)) for col, row in vertices)
    if len(points) < 2 or not np.isfinite(points).all():
        raise ModelError(
            f"The line of {what} has {len(points)} vertices; at least 2 finite ones are allowed."
        )
    for k, (a, b) in enumerate(itertools.pairwise(points)):
        if a == b:
            raise ModelError(
                f"The vertices {k} and {k + 1} of {what} are the same; different ones are allowed."
            )
    return points


def check_on_grid(what: str, vertices: Vertices, shape: tuple[int, int]) -> None:
    """Refuse a line that leaves the grid.

    Raises:
        ModelError: naming the vertex.
    """
    nrows, ncols = shape
    for k, (col, row) in enumerate(vertices):
        if not (-0.5 <= col <= ncols - 0.5 and -0.5 <= row <= nrows - 0.5):
            raise ModelError(
                f"Vertex {k} of {what} lies at (column {col:g}, row {row:g}), off the {nrows} x {ncols} grid."
            )


def check_cells(
    what: str, cells: Cells, shape: tuple[int, int], blocked: npt.NDArray[np.bool_] | None
) -> None:
    """Refuse cells that are off the grid or have no data.

    Raises:
        ModelError: naming the cell.
    """
    nrows, ncols = shape
    for row, col in cells:
        if not (0 <= row < nrows and 0 <= col < ncols):
            raise ModelError(
                f"{sentence(what)} stands in cell (row {row}, column {col}), off the {nrows} x {ncols} grid."
            )
        if blocked is not None and blocked[row, col]:
            raise ModelError(f"{sentence(what)} stands in cell (row {row}, column {col}), which has no data.")


def line_length(vertices: Vertices) -> float:
    """Length of a polyline [cells]."""
    return float(np.hypot(*np.diff(np.array(vertices), axis=0).T).sum())


def nearest_on_line(cols: RealArray, rows: RealArray, vertices: Vertices) -> NearestOnLine:
    """Where on a polyline points come closest; of equally close places the first."""
    points = np.array(vertices)
    lengths = np.hypot(*np.diff(points, axis=0).T)
    starts = np.concatenate([[0.0], np.cumsum(lengths)])
    best = np.full(cols.shape, np.inf)
    along, fraction = np.zeros(cols.shape), np.zeros(cols.shape)
    segment = np.zeros(cols.shape, np.int64)
    for k, ((x0, y0), (x1, y1)) in enumerate(itertools.pairwise(points)):
        t = ((cols - x0) * (x1 - x0) + (rows - y0) * (y1 - y0)) / lengths[k] ** 2
        t = np.clip(t, 0.0, 1.0)
        distance = np.hypot(cols - x0 - t * (x1 - x0), rows - y0 - t * (y1 - y0))
        closer = distance < best
        best = np.where(closer, distance, best)
        along = np.where(closer, starts[k] + t * lengths[k], along)
        fraction = np.where(closer, t, fraction)
        segment = np.where(closer, k, segment)
    return NearestOnLine(best, along, segment, fraction)


def line_cells(vertices: Vertices, width: float, shape: tuple[int, int]) -> IntArray:
    """Cells of a strip: centres within half the width of the line, and a chain of cells along it.

    Args:
        vertices: (column, row) of the line.
        width: width of the strip [cells].
        shape: (nrows, ncols).

    Returns:
        Rows and columns [cells, 2], by row, then column, each once.
    """
    nrows, ncols = shape
    cols, rows = np.array(vertices).T
    reach = 0.5 * width + 1.0
    row0, row1 = max(0, int(rows.min() - reach)), min(nrows, int(rows.max() + reach) + 2)
    col0, col1 = max(0, int(cols.min() - reach)), min(ncols, int(cols.max() + reach) + 2)
    y, x = np.mgrid[row0:row1, col0:col1].astype(np.float64)
    taken = nearest_on_line(x, y, vertices).distance <= 0.5 * width
    for (xa, ya), (xb, yb) in itertools.pairwise(vertices):
        steps = math.ceil(max(abs(xb - xa), abs(yb - ya)))
        part = np.arange(steps + 1) / steps
        chain_rows = np.clip(np.rint(ya + part * (yb - ya)).astype(int), 0, nrows - 1)
        chain_cols = np.clip(np.rint(xa + part * (xb - xa)).astype(int), 0, ncols - 1)
        taken[chain_rows - row0, chain_cols - col0] = True
    return (np.argwhere(taken) + np.array([row0, col0])).astype(np.int32)


def face_chain(vertices: Vertices, shape: tuple[int, int]) -> IntArray:
    """Staircase of faces nearest to a line, each face once and without a gap.

    Every segment is walked from grid corner to grid corner; of the two ways on, along the columns or along
    the rows, the one that stays nearer to the segment is taken. Faces on the rim of the grid are left out.

    Args:
        vertices: (column, row) of the line.
        shape: (nrows, ncols).

    Returns:
        Row, column and side of each face, [faces, 3], in the order of the line.
    """
    return oriented_face_chain(vertices, shape)[0]


def oriented_face_chain(vertices: Vertices, shape: tuple[int, int]) -> tuple[IntArray, IntArray]:
    """The chain of `face_chain`, and for each face 1 when it is walked east or north, else -1."""
    nrows, ncols = shape
    corners = np.clip(np.floor(np.array(vertices) + 1.0), 0, (ncols, nrows)).astype(int)
    faces: dict[tuple[int, int, int], int] = {}
    for (xa, ya), (xb, yb) in zip(corners[:-1].tolist(), corners[1:].tolist(), strict=True):
        x, y = xa, ya
        step_x, step_y = (1 if xb > xa else -1), (1 if yb > ya else -1)
        while (x, y) != (xb, yb):
            off_x = abs((x + step_x - xa) * (yb - ya) - (y - ya) * (xb - xa))
            off_y = abs((x - xa) * (yb - ya) - (y + step_y - ya) * (xb - xa))
            if y == yb or (x != xb and off_x <= off_y):
                west = min(x, x + step_x)
                if 0 < y < nrows:
                    faces.setdefault((y - 1, west, NORTH_FACE), step_x)
                x += step_x
            else:
                south = min(y, y + step_y)
                if 0 < x < ncols:
                    faces.setdefault((south, x - 1, EAST_FACE), step_y)
                y += step_y
    chain = np.array(list(faces), np.int32).reshape(-1, 3)
    return chain, np.array(list(faces.values()), np.int32)
