"""A breach that grows in a levee or dam: where it stands and by which law it grows.

The opening is a trapezoid along a line, with its middle at the middle of the line: from bottom level and
width `B` the sides rise with `side_slope`. It eats a strip of cells across the line.

    linear:                 level and width run linearly to their final values within `duration`
    verheij_van_der_knaap:  the level falls linearly within `duration`, the width stays; then
                            dB/dt = f1 f2 / ln 10  (g dH)^1.5 / u_c^2 / (1 + f2 g t / u_c)

with t the time since the end of the first phase in hours, dH the difference of the levels on both sides, each
at least the bottom level, and u_c the critical velocity of the material [Verheij2002].
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from solver_service.errors import ModelError
from solver_service.numerics.snapping import (
    NO_FACES,
    NORTH_FACE,
    Cells,
    IntArray,
    Snapped,
    Vertices,
    check_cells,
    check_on_grid,
    check_vertices,
    line_cells,
    line_length,
    nearest_on_line,
    sentence,
)
from solver_service.numerics.structures import Blocked, Structure, Weir, check_number

RIM = 2
"""A breach stays this many cells off the rim of the grid, where ghost cells mirror the bed."""


@dataclass(frozen=True)
class BreachState:
    """How far a breach has grown."""

    id: str
    """Name of the breach."""
    started_at: float | None
    """Time at which it began [s]; None while it has not."""
    width: float
    """Width at the bottom [m]; 0 before it began."""
    level: float
    """Level of the bottom relative to the case datum [m]."""


@dataclass(frozen=True)
class Breach:
    """An opening that grows.

    Raises:
        ModelError: when the line or a number is not valid.
    """

    id: str
    """Name, unlike that of any other structure or breach."""
    vertices: Vertices
    """(column, row) of the line along the crest, in cells from the centre of cell (0, 0)."""
    crest: float
    """Level of the crest relative to the case datum [m]; the bottom sinks from here."""
    bottom_level: float
    """Level that the bottom reaches [m]."""
    duration: float
    """Time in which it does [s]."""
    width_initial: float
    """Width at the beginning [m]."""
    width_final: float | None = None
    """Largest width [m]; needed by the linear law, else None is the length of the line."""
    across: float = 0.0
    """Width of the strip that is eaten, across the line [m]: the foot of the levee; 0 is a chain of cells."""
    side_slope: float = 0.0
    """Horizontal per vertical of the sides [1]; 0 is vertical."""
    start: Literal["time", "overtopping"] = "time"
    """Begin at `start_time`, or from then on as soon as the water beside the line stands above the crest."""
    start_time: float = 0.0
    """Time of the beginning, or the earliest one [s]."""
    law: Literal["linear", "verheij_van_der_knaap"] = "linear"
    """How it grows; see the module."""
    f1: float = 1.3
    """Factor of the law [1]."""
    f2: float = 0.04
    """Factor of the law [1]."""
    critical_velocity: float = 0.2
    """u_c [m/s]: 0.2 sand, 0.5 good clay."""

    def __post_init__(self) -> None:
        what = self.name
        object.__setattr__(self, "vertices", check_vertices(what, self.vertices))
        check_number(what, "crest", self.crest, True, "a finite level in m")
        below = f"below the crest {self.crest:g} m"
        check_number(what, "bottom_level", self.bottom_level, self.bottom_level < self.crest, below)
        check_number(what, "duration", self.duration, self.duration > 0.0, "a positive time in s")
        check_number(what, "width_initial", self.width_initial, self.width_initial >= 0.0, "0 m or more")
        check_number(what, "across", self.across, self.across >= 0.0, "0 m or more")
        check_number(what, "side_slope", self.side_slope, 0.0 <= self.side_slope <= 20.0, "0 to 20")
        check_number(what, "start_time", self.start_time, self.start_time >= 0.0, "0 s or later")
        check_number(what, "f1", self.f1, 0.0 < self.f1 <= 10.0, "above 0 to 10")
        check_number(what, "f2", self.f2, 0.0 < self.f2 <= 10.0, "above 0 to 10")
        velocity = self.critical_velocity
        check_number(what, "critical_velocity", velocity, 0.01 <= velocity <= 10.0, "0.01 to 10 m/s")
        if self.start not in ("time", "overtopping"):
            raise ModelError(f'The start of {what} is {self.start!r}; "time" or "overtopping" is allowed.')
        if self.law not in ("linear", "verheij_van_der_knaap"):
            raise ModelError(
                f'The law of {what} is {self.law!r}; "linear" or "verheij_van_der_knaap" is allowed.'
            )
        if self.width_final is None and self.law == "linear":
            raise ModelError(f"{sentence(what)} grows linearly to no width; give width_final in m.")
        if self.width_final is not None:
            least = self.width_initial
            check_number(
                what, "width_final", self.width_final, self.width_final >= max(least, 1e-3),
                f"above 0 and at least the initial width {least:g} m",
            )  # fmt: skip

    @property
    def name(self) -> str:
        """The breach in sentences."""
        return f"the breach {self.id!r}"

    def widest(self, dx: float) -> float:
        """Largest width [m] on cells of side `dx` [m]."""
        return line_length(self.vertices) * dx if self.width_final is None else self.width_final

    def footprint(self, shape: tuple[int, int], dx: float) -> tuple[IntArray, np.ndarray]:
        """Cells that the breach may ever eat, [cells, 2], and their way along the line from its middle [m].

        Args:
            shape: (nrows, ncols).
            dx: cell side [m].
        """
        cells = line_cells(self.vertices, self.across / dx, shape)
        nearest = nearest_on_line(cells[:, 1].astype(float), cells[:, 0].astype(float), self.vertices)
        along = (nearest.along - 0.5 * line_length(self.vertices)) * dx
        reach = 0.5 * self.widest(dx) + self.side_slope * (self.crest - self.bottom_level) + 0.5 * dx
        near = np.abs(along) < reach
        return cells[near], along[near]

    def probes(self, dx: float) -> Cells:
        """(row, column) of the two cells, one on each side, whose water levels drive the breach."""
        points = np.array(self.vertices)
        lengths = np.hypot(*np.diff(points, axis=0).T)
        reached = np.concatenate([[0.0], np.cumsum(lengths)])
        k = min(int(np.searchsorted(reached, 0.5 * reached[-1], side="right")) - 1, lengths.size - 1)
        tangent = (points[k + 1] - points[k]) / lengths[k]
        middle = points[k] + (0.5 * reached[-1] - reached[k]) * tangent
        normal = np.array([-tangent[1], tangent[0]])
        away = max(0.5 * self.across / dx, 0.5) + 1.0
        places = (middle + away * normal, middle - away * normal)
        return tuple((int(np.floor(row + 0.5)), int(np.floor(col + 0.5))) for col, row in places)

    def snapped(self, shape: tuple[int, int], dx: float) -> Snapped:
        """Cells that the breach may ever eat."""
        return Snapped(self.footprint(shape, dx)[0], NO_FACES)

    def check_on(self, shape: tuple[int, int], dx: float, blocked: Blocked) -> None:
        """Refuse a breach that the grid has no place for.

        Raises:
            ModelError: when it leaves the grid, comes too close to its rim, stands on cells without data or
                is wider than its line.
        """
        check_on_grid(self.name, self.vertices, shape)
        length = line_length(self.vertices) * dx
        if self.widest(dx) > length * (1.0 + 1e-9):
            raise ModelError(
                f"The width_final of {self.name} is {self.width_final:g} m; at most the length of its line,"
                f" {length:g} m, is allowed."
            )
        cells = self.footprint(shape, dx)[0]
        nrows, ncols = shape
        off = (cells < RIM).any(axis=1) | (cells[:, 0] >= nrows - RIM) | (cells[:, 1] >= ncols - RIM)
        if off.any():
            row, col = cells[off][0].tolist()
            raise ModelError(
                f"{sentence(self.name)} reaches cell (row {row}, column {col}); at least {RIM} cells off"
                " the rim of the grid are allowed."
            )
        check_cells(f"a probe of {self.name}", self.probes(dx), shape, blocked)
        check_cells(self.name, tuple(map(tuple, cells.tolist())), shape, blocked)


def refuse_walls_in_breaches(
    structures: tuple[Structure, ...], breaches: tuple[Breach, ...], shape: tuple[int, int], dx: float
) -> None:
    """Refuse a weir at a cell that a breach eats: a breach lowers the ground and leaves walls standing.

    Raises:
        ModelError: naming both and the cell.
    """
    walled: dict[tuple[int, int], Weir] = {}
    for weir in structures if breaches else ():
        if isinstance(weir, Weir):
            for row, col, side in weir.snapped(shape, dx).faces.tolist():
                beyond = (row + 1, col) if side == NORTH_FACE else (row, col + 1)
                walled |= {(row, col): weir, beyond: weir}
    for breach in breaches:
        for row, col in breach.footprint(shape, dx)[0].tolist():
            if (row, col) in walled:
                raise ModelError(
                    f"{sentence(breach.name)} reaches cell (row {row}, column {col}), at which"
                    f" {walled[row, col].name} stands; a weir that ends beside the breach is allowed."
                )
