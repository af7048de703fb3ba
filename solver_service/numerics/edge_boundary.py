"""What happens at the edges of the grid, segment by segment, with the checks of what is asked."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
import numpy.typing as npt

from solver_service.errors import ModelError
from solver_service.numerics.inflows import check_series

Edge = Literal["west", "east", "south", "north"]
EDGES: tuple[Edge, ...] = get_args(Edge)

EdgeKind = Literal["wall", "open", "stage", "discharge", "normal_depth"]
EDGE_KINDS: tuple[EdgeKind, ...] = get_args(EdgeKind)

SERIES_KINDS = ("stage", "discharge")
"""Kinds that need a series."""

SLOPE_MAX = 1.0
"""Steepest slope that a normal depth is computed for [1]."""


@dataclass(frozen=True)
class EdgeBoundary:
    """What happens along a part of an edge; where nothing is said stands a wall.

    - `wall` reflects.
    - `open` lets water leave and none enter: waves pass into the water that stood there at the start, and
      where it was dry the water falls off the edge at critical depth.
    - `stage` sets the water level, so that water enters and leaves.
    - `discharge` lets a given discharge enter (negative: leave), spread over the segment by conveyance.
    - `normal_depth` lets water leave as uniform flow on a given slope does.

    Raises:
        ModelError: when edge, kind, range, series or slope are not valid.
    """

    edge: Edge
    """Side of the grid."""
    kind: EdgeKind
    """See the class."""
    first: int
    """First cell along the edge, counted from the south or the west."""
    last: int
    """One past the last cell."""
    id: str = ""
    """Name in the budget; unnamed ones are west-1, west-2, ... by their place along the list."""
    times: npt.NDArray[np.float64] | None = None
    """Times of the series [s], increasing; for `stage` and `discharge` alone."""
    values: npt.NDArray[np.float64] | None = None
    """Water level relative to the case datum [m] or discharge into the domain [m3/s] at these times.

    Linear between; the first value holds before them, the last one after.
    """
    slope: float | None = None
    """Slope of the bed and the water beyond the edge [1], 0 < slope <= 1; for `normal_depth` alone."""

    def __post_init__(self) -> None:
        if self.edge not in EDGES:
            raise ModelError(f"The boundary edge is {self.edge!r}; allowed are {', '.join(EDGES)}.")
        if self.kind not in EDGE_KINDS:
            raise ModelError(f"The boundary kind is {self.kind!r}; allowed are {', '.join(EDGE_KINDS)}.")
        if not 0 <= self.first < self.last:
            raise ModelError(
                f"The boundary spans the cells {self.first} to {self.last}; 0 <= first < last is allowed."
            )
        self._check_series()
        self._check_slope()

    def _check_series(self) -> None:
        if self.kind not in SERIES_KINDS:
            if self.times is not None or self.values is not None:
                raise ModelError(
                    f"A {self.kind} boundary has a series; only {' and '.join(SERIES_KINDS)} have one."
                )
            return
        if self.times is None or self.values is None:
            raise ModelError(f"A {self.kind} boundary has no series; times and values are needed.")
        for name in ("times", "values"):
            object.__setattr__(self, name, np.atleast_1d(np.asarray(getattr(self, name), np.float64)))
        check_series(f"a {self.kind} boundary", self.times, self.values, lowest=-np.inf)

    def _check_slope(self) -> None:
        if self.kind != "normal_depth":
            if self.slope is not None:
                raise ModelError(f"A {self.kind} boundary has a slope; only normal_depth has one.")
        elif self.slope is None or not 0.0 < self.slope <= SLOPE_MAX:
            raise ModelError(
                f"A normal_depth boundary has the slope {self.slope!r}; "
                f"0 < slope <= {SLOPE_MAX:g} is allowed."
            )

    @property
    def may_bring_water(self) -> bool:
        """Whether water may enter here."""
        return self.kind in SERIES_KINDS


def check_boundaries(
    boundaries: tuple[EdgeBoundary, ...],
    shape: tuple[int, int],
    blocked: npt.NDArray[np.bool_] | None,
) -> None:
    """Refuse segments that leave the grid, overlap, share a name, or have no cell to bring water to.

    Args:
        boundaries: the segments of a model.
        shape: (nrows, ncols).
        blocked: cells outside the computation, [nrows, ncols]; None where there are none.

    Raises:
        ModelError: naming the segment.
    """
    lengths = dict(zip(EDGES, (shape[0], shape[0], shape[1], shape[1]), strict=True))
    taken = {edge: np.zeros(lengths[edge], np.bool_) for edge in EDGES}
    names: set[str] = set()
    for boundary in boundaries:
        edge, cells = boundary.edge, slice(boundary.first, boundary.last)
        if boundary.last > lengths[edge]:
            raise ModelError(
                f"The {edge} boundary ends at cell {boundary.last}; the edge has {lengths[edge]}."
            )
        twice = np.flatnonzero(taken[edge][cells])
        if twice.size:
            cell = boundary.first + int(twice[0])
            raise ModelError(f"Two {edge} boundaries share cell {cell}; each cell once is allowed.")
        taken[edge][cells] = True
        if boundary.id and boundary.id in names:
            raise ModelError(f"Two boundaries are named {boundary.id!r}; each name once is allowed.")
        names.add(boundary.id)
        if blocked is not None and boundary.kind == "discharge" and edge_cells(blocked, edge)[cells].all():
            raise ModelError(
                f"The {edge} discharge boundary of the cells {boundary.first} to {boundary.last} "
                "has no cell with data."
            )


def edge_cells(raster: npt.NDArray, edge: Edge) -> npt.NDArray:
    """View of the cells of a raster [nrows, ncols] that lie along an edge, from the south or the west."""
    views = {"west": raster[:, 0], "east": raster[:, -1], "south": raster[0], "north": raster[-1]}
    return views[edge]
