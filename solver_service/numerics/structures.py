"""What engineers build into a flood: walls thinner than a cell, culverts, pumps."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt

from solver_service.errors import ModelError
from solver_service.numerics.snapping import (
    NO_CELLS,
    NO_FACES,
    NORTH_FACE,
    Cells,
    RealArray,
    Snapped,
    Vertices,
    check_cells,
    check_on_grid,
    check_vertices,
    face_chain,
    nearest_on_line,
    sentence,
)

Blocked = npt.NDArray[np.bool_] | None


def check_number(what: str, name: str, value: float, holds: bool, allowed: str) -> None:
    """Refuse a number of a structure.

    Raises:
        ModelError: naming structure, number, value and what is allowed.
    """
    if not (math.isfinite(value) and holds):
        raise ModelError(f"The {name} of {what} is {value!r}; allowed is {allowed}.")


@dataclass(frozen=True)
class Weir:
    """A wall or levee thinner than a cell, along faces between cells; water passes above its crest alone.

    Raises:
        ModelError: when the line, the crest or the coefficient are not valid.
    """

    id: str
    """Name, unlike that of any other structure."""
    vertices: Vertices
    """(column, row) of the line in cells from the centre of cell (0, 0)."""
    crest: float | tuple[float, ...]
    """Level of the crest relative to the case datum [m], one or one per vertex, linear between."""
    coefficient: float = 1.7
    """C in q = C H^1.5 [m^0.5/s]: 1.7 broad crest, 1.84 sharp crest."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "vertices", check_vertices(self.name, self.vertices))
        levels = np.atleast_1d(np.asarray(self.crest, np.float64))
        if levels.shape not in ((1,), (len(self.vertices),)):
            raise ModelError(
                f"The crest of {self.name} has {levels.size} levels; 1 or {len(self.vertices)} are allowed."
            )
        for level in levels.tolist():
            check_number(self.name, "crest", level, True, "a finite level in m")
        object.__setattr__(self, "crest", float(levels[0]) if levels.size == 1 else tuple(levels.tolist()))
        allowed = "0.1 to 4 m^0.5/s"
        check_number(self.name, "coefficient", self.coefficient, 0.1 <= self.coefficient <= 4.0, allowed)

    @property
    def name(self) -> str:
        """The weir in sentences."""
        return f"the weir {self.id!r}"

    def snapped(self, shape: tuple[int, int], dx: float) -> Snapped:
        """Faces on a grid of `shape` (nrows, ncols); they do not depend on the cell size."""
        return Snapped(NO_CELLS, face_chain(self.vertices, shape))

    def face_levels(self, faces: npt.NDArray[np.int32]) -> tuple[RealArray, RealArray]:
        """Crest level [m] and share of the face's length that the line has there [1], at each face.

        A staircase is longer than its line; the shares make up for that where water falls over freely.
        """
        northern = faces[:, 2] == NORTH_FACE
        cols = faces[:, 1].astype(np.float64) + np.where(northern, 0.0, 0.5)
        rows = faces[:, 0].astype(np.float64) + np.where(northern, 0.5, 0.0)
        nearest = nearest_on_line(cols, rows, self.vertices)
        levels = np.broadcast_to(np.asarray(self.crest, np.float64), (len(self.vertices),))
        before, after = levels[nearest.segment], levels[nearest.segment + 1]
        steps = np.abs(np.diff(np.array(self.vertices), axis=0))
        shares = np.hypot(*steps.T) / steps.sum(axis=1)
        return before + nearest.fraction * (after - before), shares[nearest.segment]

    def check_on(self, shape: tuple[int, int], dx: float, blocked: Blocked) -> None:
        """Refuse a weir that the grid has no place for.

        Raises:
            ModelError: when it leaves the grid or takes no face inside it.
        """
        check_on_grid(self.name, self.vertices, shape)
        if not len(self.snapped(shape, dx).faces):
            raise ModelError(
                f"{sentence(self.name)} takes no face between two cells of the grid;"
                " a line longer than a cell and off the rim is allowed."
            )


@dataclass(frozen=True)
class Culvert:
    """A short conduit under a road or levee; see `conduit_kernels` for the formulas.

    A pipe of diameter D counts as the box of the same height and area: height D, width pi D / 4.

    Raises:
        ModelError: when a number is out of its range, or a cell stands on both ends.
    """

    id: str
    """Name, unlike that of any other structure."""
    inlet: Cells
    """(row, column) of the cells it draws from."""
    outlet: Cells
    """(row, column) of the cells it fills."""
    invert_inlet: float
    """Floor at the inlet relative to the case datum [m]."""
    invert_outlet: float
    """Floor at the outlet [m]."""
    width: float
    """Width of one barrel [m]."""
    height: float
    """Height of one barrel [m]."""
    length: float
    """Length [m]."""
    barrels: int = 1
    """Equal barrels side by side."""
    manning_n: float = 0.013
    """Roughness of the barrel [s m^(-1/3)]."""
    entrance_loss: float = 0.5
    """Loss at the entrance in velocity heads [1]."""
    orifice_coefficient: float = 0.6
    """C_d of the drowned entrance [1]."""
    both_ways: bool = True
    """Whether water may run from outlet to inlet; else a flap gate holds it."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "inlet", _cells(self.inlet))
        object.__setattr__(self, "outlet", _cells(self.outlet))
        _check_ends(self.name, self.inlet, self.outlet)
        for number in ("invert_inlet", "invert_outlet"):
            check_number(self.name, number, getattr(self, number), True, "a finite level in m")
        for number, most in (("width", 100.0), ("height", 50.0), ("length", 10_000.0)):
            value = getattr(self, number)
            check_number(self.name, number, value, 0.0 < value <= most, f"above 0 to {most:g} m")
        check_number(self.name, "barrels", self.barrels, self.barrels >= 1, "1 or more")
        check_number(self.name, "manning_n", self.manning_n, 0.0 <= self.manning_n <= 0.2, "0 to 0.2")
        loss = self.entrance_loss
        check_number(self.name, "entrance_loss", loss, 0.0 <= loss <= 10.0, "0 to 10")
        orifice = self.orifice_coefficient
        check_number(self.name, "orifice_coefficient", orifice, 0.1 <= orifice <= 1.0, "0.1 to 1")

    @property
    def name(self) -> str:
        """The culvert in sentences."""
        return f"the culvert {self.id!r}"

    @property
    def loss(self) -> float:
        """Loss of the full barrel in velocity heads [1]: entrance, exit and friction."""
        radius = self.width * self.height / (2.0 * (self.width + self.height))
        return self.entrance_loss + 1.0 + 2.0 * 9.81 * self.manning_n**2 * self.length / radius ** (4.0 / 3.0)

    def snapped(self, shape: tuple[int, int], dx: float) -> Snapped:
        """Inlet cells, then outlet cells."""
        return Snapped(np.array(self.inlet + self.outlet, np.int32), NO_FACES)

    def check_on(self, shape: tuple[int, int], dx: float, blocked: Blocked) -> None:
        """Refuse cells that are not there.

        Raises:
            ModelError: naming the cell.
        """
        check_cells(self.name, self.inlet + self.outlet, shape, blocked)


@dataclass(frozen=True)
class Pump:
    """A pump with a rating, switched by the level before it.

    Raises:
        ModelError: when the rating or a level is not valid, or a cell stands on both ends.
    """

    id: str
    """Name, unlike that of any other structure."""
    inlet: Cells
    """(row, column) of the cells it draws from."""
    outlet: Cells | None
    """(row, column) of the cells it fills; None pumps out of the domain."""
    rating: tuple[float, ...]
    """Levels or heads of the rating [m], increasing."""
    discharge: tuple[float, ...]
    """Discharge at these [m3/s], >= 0, linear between, held outside."""
    rating_against: Literal["level", "head"] = "level"
    """`level`: water level at the inlet relative to the datum; `head`: level at the outlet less that."""
    start_level: float | None = None
    """Level at the inlet at which it starts [m]; None runs always."""
    stop_level: float | None = None
    """Level at the inlet at which it stops [m], at most the start level; None is the start level."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "inlet", _cells(self.inlet))
        object.__setattr__(self, "outlet", None if self.outlet is None else _cells(self.outlet))
        _check_ends(self.name, self.inlet, self.outlet)
        for name in ("rating", "discharge"):
            values = tuple(np.atleast_1d(np.asarray(getattr(self, name), np.float64)).tolist())
            object.__setattr__(self, name, values)
        if len(self.rating) != len(self.discharge) or not self.rating:
            raise ModelError(
                f"The rating of {self.name} has {len(self.rating)} levels and {len(self.discharge)}"
                " discharges; as many, at least 1."
            )
        for k, (level, discharge) in enumerate(zip(self.rating, self.discharge, strict=True)):
            check_number(self.name, f"rating {k}", level, True, "a finite number of m")
            check_number(self.name, f"discharge {k}", discharge, discharge >= 0.0, "0 m3/s or more")
            if k and level <= self.rating[k - 1]:
                raise ModelError(
                    f"Entry {k} of the rating of {self.name} is {level} m;"
                    f" above {self.rating[k - 1]} m is allowed."
                )
        if self.rating_against not in ("level", "head"):
            raise ModelError(
                f'The rating of {self.name} is against {self.rating_against!r}; "level" or "head" is allowed.'
            )
        if self.rating_against == "head" and self.outlet is None:
            raise ModelError(f'{sentence(self.name)} pumps out of the domain: its rating is against "level".')
        self._check_switch()

    def _check_switch(self) -> None:
        start, stop = self.start_level, self.stop_level
        if start is None and stop is not None:
            raise ModelError(f"{sentence(self.name)} has a stop level but no start level; both or none.")
        if start is not None:
            check_number(self.name, "start level", start, True, "a finite level in m")
            stop = start if stop is None else stop
            check_number(self.name, "stop level", stop, stop <= start, f"at most the start level {start:g} m")
            object.__setattr__(self, "stop_level", stop)

    @property
    def name(self) -> str:
        """The pump in sentences."""
        return f"the pump {self.id!r}"

    def snapped(self, shape: tuple[int, int], dx: float) -> Snapped:
        """Inlet cells, then outlet cells."""
        return Snapped(np.array(self.inlet + (self.outlet or ()), np.int32), NO_FACES)

    def check_on(self, shape: tuple[int, int], dx: float, blocked: Blocked) -> None:
        """Refuse cells that are not there.

        Raises:
            ModelError: naming the cell.
        """
        check_cells(self.name, self.inlet + (self.outlet or ()), shape, blocked)


Structure = Weir | Culvert | Pump


def _cells(cells: Cells) -> Cells:
    return tuple((int(row), int(col)) for row, col in cells)


def _check_ends(what: str, inlet: Cells, outlet: Cells | None) -> None:
    for end, cells in (("inlet", inlet), ("outlet", outlet)):
        if cells is not None and (not cells or len(set(cells)) != len(cells)):
            raise ModelError(
                f"The {end} of {what} has {len(cells)} cells; at least 1, each once, is allowed."
            )
    for row, col in set(inlet) & set(outlet or ()):
        raise ModelError(
            f"Cell (row {row}, column {col}) is inlet and outlet of {what}; different cells are allowed."
        )
