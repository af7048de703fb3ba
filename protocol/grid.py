"""Where the cells are: the only conversion between rows, columns and the case's coordinates.

Row 0 is the southern edge, column 0 the western one. Values belong to cell centres:
x = x0 + (col + 0.5) dx, y = y0 + (row + 0.5) dx.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from protocol.errors import GridError
from protocol.limits import MAX_CELLS, MAX_SIDE


@dataclass(frozen=True)
class GridGeometry:
    """A uniform grid of square cells on a projected map.

    Attributes:
        nrows: number of rows, from south to north.
        ncols: number of columns, from west to east.
        dx: cell size [m].
        x0: x of the south-western corner of the grid (not of a cell centre) [m].
        y0: y of the south-western corner of the grid [m].
        crs: name of the projected coordinate system, or "local".
        vertical_datum: what elevation 0 means, for people.
        datum_offset: elevation [m] that z_b is stored relative to: real elevation = z_b + datum_offset.

    Raises:
        GridError: when a number is not finite or out of range.
    """

    nrows: int
    ncols: int
    dx: float
    x0: float = 0.0
    y0: float = 0.0
    crs: str = "local"
    vertical_datum: str = ""
    datum_offset: float = 0.0

    def __post_init__(self) -> None:
        for name in ("nrows", "ncols"):
            count = getattr(self, name)
            if not 1 <= count <= MAX_SIDE:
                raise GridError(f"Grid {name} is {count!r}; 1 to {MAX_SIDE} is allowed.")
        if self.nrows * self.ncols > MAX_CELLS:
            raise GridError(f"Grid has {self.nrows * self.ncols} cells; up to {MAX_CELLS} are allowed.")
        if not (math.isfinite(self.dx) and self.dx > 0.0):
            raise GridError(f"Grid dx is {self.dx!r}; a finite cell size above 0 m is allowed.")
        for name in ("x0", "y0", "datum_offset"):
            if not math.isfinite(getattr(self, name)):
                raise GridError(f"Grid {name} is {getattr(self, name)!r}; a finite number is allowed.")

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns, as arrays have them."""
        return (self.nrows, self.ncols)

    @property
    def cell_count(self) -> int:
        """Number of cells."""
        return self.nrows * self.ncols

    @property
    def extent(self) -> tuple[float, float, float, float]:
        """Outer edges (xmin, ymin, xmax, ymax) [m]."""
        return (self.x0, self.y0, self.x0 + self.ncols * self.dx, self.y0 + self.nrows * self.dx)

    def center(self, row: float, col: float) -> tuple[float, float]:
        """Coordinates (x, y) [m] of a cell centre; fractions of a cell are allowed."""
        return (self.x0 + (col + 0.5) * self.dx, self.y0 + (row + 0.5) * self.dx)

    def to_cell(self, x: float, y: float) -> tuple[float, float]:
        """Fractional (row, col) of a point; whole numbers are cell centres."""
        return ((y - self.y0) / self.dx - 0.5, (x - self.x0) / self.dx - 0.5)

    def contains(self, x: float, y: float) -> bool:
        """Whether a point lies within the outer edges."""
        xmin, ymin, xmax, ymax = self.extent
        return xmin <= x <= xmax and ymin <= y <= ymax
