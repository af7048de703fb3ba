"""A case: everything a run needs, checked, and nothing that changes."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from protocol import EditLine, GridGeometry
from solver_service.numerics import FloodModel, SolverParams
from solver_service.numerics.section import Section

Point = tuple[float, float]


@dataclass(frozen=True)
class Gauge:
    """A place where depth, level and velocity are recorded.

    Attributes:
        id: its name.
        x: easting [m].
        y: northing [m].
    """

    id: str
    x: float
    y: float


@dataclass(frozen=True)
class DemoScript:
    """What a tour of the case may show.

    Attributes:
        time: simulation time at which the edit is drawn [s].
        target: where the camera looks, x and y [m]; None for the middle of the grid.
        edits: levees or trenches.
    """

    time: float
    target: Point | None
    edits: tuple[EditLine, ...]


@dataclass(frozen=True)
class Case:
    """A data set with its forcing.

    The gauges of `params` are the case's gauges, in their order; its sections are the case's, then one along
    the line of each weir and breach.

    Attributes:
        name: short name, letters, digits, `_` and `-`.
        title: one line for people.
        description: more lines for people.
        hypothetical: whether the event never happened; shown on every picture.
        source: where the data comes from.
        licence: licence of the data.
        start_time: clock time of time 0, ISO 8601 with offset; None where it has none.
        grid: where the cells are.
        z_b: bed [m, relative to grid.datum_offset], float32 [nrows, ncols].
        model: what the solver takes.
        initial_h: depth at time 0 [m], float32 [nrows, ncols].
        duration: simulated time [s].
        output_interval: time between frames [s].
        params: how it is solved, and the cells and sections that are recorded.
        gauges: places recorded.
        sections: lines recorded.
        nodata_count: cells of the terrain without data, walled or filled.
        warnings: sentences about what is allowed in the case and yet odd.
        imagery: picture to lay on the terrain; None where there is none.
        demo: what a tour may show; None where nothing is said.
    """

    name: str
    title: str
    description: str
    hypothetical: bool
    source: str
    licence: str
    start_time: str | None
    grid: GridGeometry
    z_b: NDArray[np.float32]
    model: FloodModel
    initial_h: NDArray[np.float32]
    duration: float
    output_interval: float
    params: SolverParams
    gauges: tuple[Gauge, ...]
    sections: tuple[Section, ...]
    nodata_count: int
    warnings: tuple[str, ...] = ()
    imagery: Path | None = None
    demo: DemoScript | None = None

    @property
    def demo_edit(self) -> list[EditLine] | None:
        """The edits of the tour, None where there are none."""
        return list(self.demo.edits) if self.demo and self.demo.edits else None
