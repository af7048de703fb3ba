"""What does not move while a run goes on: grid, bed, roughness, edges, sources, rain."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from solver_service.errors import ModelError
from solver_service.numerics.breach import Breach, refuse_walls_in_breaches
from solver_service.numerics.edge_boundary import EdgeBoundary, check_boundaries
from solver_service.numerics.fields import FloatRaster
from solver_service.numerics.infiltration import Infiltration
from solver_service.numerics.inflows import Rain, Source
from solver_service.numerics.structures import Structure

MANNING_MAX = 10.0
"""Largest Manning roughness accepted [s m^(-1/3)]."""


@dataclass(frozen=True)
class FloodModel:
    """Everything about a flood that a solver needs, but for the water itself.

    Rasters are [row, col] with row 0 in the south.

    Raises:
        ModelError: naming what is not valid, with its cell where there is one.
    """

    dx: float
    """Cell side [m]."""
    z_b: FloatRaster
    """Bed elevation relative to the case datum [m], finite, float32 [nrows, ncols]."""
    manning_n: float | FloatRaster
    """Manning roughness [s m^(-1/3)], one value or a raster."""
    boundaries: tuple[EdgeBoundary, ...] = ()
    """Edge segments, none of which overlap; elsewhere stand walls."""
    sources: tuple[Source, ...] = ()
    """Point and disc inflows."""
    rain: Rain | None = None
    """Rain on the cells that are not blocked."""
    infiltration: Infiltration | None = None
    """What the ground takes of the water on it."""
    structures: tuple[Structure, ...] = ()
    """Weirs, culverts and pumps."""
    breaches: tuple[Breach, ...] = ()
    """Openings that grow in levees and dams."""
    blocked: npt.NDArray[np.bool_] | None = field(default=None)
    """Cells outside the computation (no data): walls."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "z_b", np.ascontiguousarray(self.z_b, np.float32))
        if self.z_b.ndim != 2 or min(self.z_b.shape) < 2:
            raise ModelError(
                f"The bed has the shape {self.z_b.shape}; two dimensions of at least 2 cells are allowed."
            )
        if not (np.isfinite(self.dx) and self.dx > 0.0):
            raise ModelError(f"The cell size is {self.dx!r}; a positive number of metres is allowed.")
        self._check_bed_and_roughness()
        check_boundaries(self.boundaries, self.shape, self.blocked)
        for source in self.sources:
            self._check_source(source)
        for built in (*self.structures, *self.breaches):
            built.check_on(self.shape, self.dx, self.blocked)
        refuse_walls_in_breaches(self.structures, self.breaches, self.shape, self.dx)
        if self.rain is not None:
            covered = (self.rain.row_index.size, self.rain.col_index.size)
            if covered != self.z_b.shape:
                raise ModelError(
                    f"The rain covers {covered} rows and columns; the grid's are {self.z_b.shape}."
                )

        if self.infiltration is not None and self.infiltration.zone is not None:
            zones = self.infiltration.zone.shape
            if zones != self.z_b.shape:
                raise ModelError(
                    f"The infiltration's zones have the shape {zones}; the bed's is {self.z_b.shape}."
                )

    @property
    def shape(self) -> tuple[int, int]:
        """(nrows, ncols)."""
        return (self.z_b.shape[0], self.z_b.shape[1])

    def _check_bed_and_roughness(self) -> None:
        if self.blocked is not None and self.blocked.shape != self.z_b.shape:
            raise ModelError(
                f"The blocked mask has the shape {self.blocked.shape}; the bed's is {self.z_b.shape}."
            )
        bad = np.argwhere(~np.isfinite(self.z_b))
        if bad.size:
            row, col = bad[0]
            raise ModelError(
                f"The bed is {self.z_b[row, col]} in cell (row {row}, column {col}); finite is allowed."
            )
        n = np.asarray(self.manning_n, np.float32)
        if n.ndim not in (0, 2) or (n.ndim == 2 and n.shape != self.z_b.shape):
            raise ModelError(f"The roughness has the shape {n.shape}; the bed's is {self.z_b.shape}.")
        wrong = np.argwhere(np.atleast_2d(~((n >= 0.0) & (n <= MANNING_MAX))))
        if wrong.size:
            value = np.atleast_2d(n)[tuple(wrong[0])]
            raise ModelError(
                f"The roughness is {value} in cell {tuple(wrong[0].tolist())}; 0 to {MANNING_MAX} is allowed."
            )

    def _check_source(self, source: Source) -> None:
        nrows, ncols = self.shape
        for row, col in zip(source.rows.tolist(), source.cols.tolist(), strict=True):
            if not (0 <= row < nrows and 0 <= col < ncols):
                raise ModelError(
                    f"A source stands in cell (row {row}, column {col}), off the {nrows} x {ncols} grid."
                )
            if self.blocked is not None and self.blocked[row, col]:
                raise ModelError(f"A source stands in cell (row {row}, column {col}), which has no data.")
