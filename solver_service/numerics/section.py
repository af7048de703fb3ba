"""A line through which the discharge is watched, and where it runs on the grid.

The line becomes a chain of faces (see `snapping`). Discharge counts positive to the right of the line,
looking from its first vertex to its last: through a line drawn from south to north, water that flows east.
The water that a chain counts is the water that the solver moved through its faces, so that a closed ring
accounts for the stored water inside, but for what sources, rain and structures bring there.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from solver_service.errors import ModelError
from solver_service.numerics.snapping import (
    NO_CELLS,
    NORTH_FACE,
    IntArray,
    RealArray,
    Snapped,
    Vertices,
    check_on_grid,
    check_vertices,
    oriented_face_chain,
)


@dataclass(frozen=True)
class Section:
    """A section line.

    Raises:
        ModelError: when the id is empty or the line has fewer than two different vertices.
    """

    id: str
    """Name of the section."""
    line: Vertices
    """(column, row) of the vertices in cells from the centre of cell (0, 0)."""

    def __post_init__(self) -> None:
        if not self.id:
            raise ModelError("A section has no id; a name is needed.")
        object.__setattr__(self, "line", check_vertices(f"section {self.id!r}", self.line))

    def snapped(self, shape: tuple[int, int]) -> Snapped:
        """The faces that the section takes on a grid of (nrows, ncols) cells."""
        return Snapped(NO_CELLS, self.chain(shape).faces)

    def chain(self, shape: tuple[int, int]) -> SectionChain:
        """The chain of faces on a grid of (nrows, ncols) cells.

        Raises:
            ModelError: when the line leaves the grid, or is so short that it takes no face inside.
        """
        what = f"section {self.id!r}"
        check_on_grid(what, self.line, shape)
        faces, forward = oriented_face_chain(self.line, shape)
        if not len(faces):
            raise ModelError(
                f"The line of {what} takes no face inside the grid; one of at least a cell is allowed."
            )
        northern = faces[:, 2] == NORTH_FACE
        # Walking east the right is south, walking north it is east.
        sign = np.where(northern, -forward, forward).astype(np.float32)
        return SectionChain(faces, sign, self._share(faces, sign))

    def _share(self, faces: IntArray, sign: npt.NDArray[np.float32]) -> npt.NDArray[np.float32]:
        """How much of the line each face stands for: the part of its side that lies along the line."""
        points = np.array(self.line)
        steps = np.diff(points, axis=0)
        lengths = np.hypot(*steps.T)
        middle = np.column_stack([faces[:, 1] + 0.5, faces[:, 0].astype(np.float64)])
        northern = faces[:, 2] == NORTH_FACE
        middle[northern] = np.column_stack([faces[northern, 1], faces[northern, 0] + 0.5])
        part = ((middle[:, None] - points[:-1]) * steps).sum(axis=2) / lengths**2
        foot = points[:-1] + np.clip(part, 0.0, 1.0)[:, :, None] * steps
        near = np.hypot(*np.moveaxis(middle[:, None] - foot, 2, 0)).argmin(axis=1)
        along = steps[near] / lengths[near, None]
        normal = np.where(northern, -along[:, 0], along[:, 1])
        return np.maximum(normal * sign, 0.0).astype(np.float32)


@dataclass(frozen=True)
class SectionChain:
    """Faces of a section in the order of its line."""

    faces: IntArray
    """Row, column and side, 0 the eastern face of that cell and 1 the northern, [faces, 3], each once."""
    sign: npt.NDArray[np.float32]
    """1 where east or north is to the right of the line, else -1."""
    share: npt.NDArray[np.float32]
    """Length of the line that each face stands for, in sides [1]: the cosine between face and line."""


@dataclass(frozen=True)
class SectionSeries:
    """What passed the sections; arrays are [time, section] except `times`."""

    times: RealArray
    """Times [s], multiples of the gauge interval."""
    discharge: RealArray
    """Discharge of the step that led to or past each time [m3/s], positive to the right of the line."""
    volume: RealArray
    """Volume that has passed since the start [m3], net."""
    area: RealArray
    """Wet area [m2]."""


@dataclass(frozen=True)
class SectionTotals:
    """What has passed one section since the start, every step counted."""

    id: str
    """Name of the section."""
    volume: float
    """Volume to the right less that to the left [m3]."""
    peak: float
    """Discharge of the largest magnitude, with its sign [m3/s]."""
    peak_time: float
    """Time of it [s]; NaN before anything passed."""


@dataclass(frozen=True)
class SectionProfile:
    """The water along a section now, one entry per face in the order of the line."""

    distance: RealArray
    """Place of the face along the line [m]."""
    z_b: RealArray
    """Bed at the face [m], the higher of both sides."""
    h: RealArray
    """Depth, mean of both sides [m]."""
    speed: RealArray
    """Velocity to the right across the line [m/s]."""
