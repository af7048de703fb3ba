"""The exact state of a run between two steps: restored, it goes on bit for bit."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy.typing as npt

from solver_service.errors import ModelError
from solver_service.numerics.fields import MAXIMA_NAMES, STATE_NAMES

RASTERS = (*STATE_NAMES, *MAXIMA_NAMES, "z_b")
"""Names of the rasters of a snapshot, each [nrows, ncols]."""

OTHER_ARRAYS = ("edge_flow", "released", "gauge_records")
NUMBERS = ("time", "step_count", "dt", "wave_speed", "initial_volume", "edits_volume")


@dataclass(frozen=True)
class Snapshot:
    """Arrays and numbers of a state, in host memory; nothing in it is shared with the solver."""

    arrays: Mapping[str, npt.NDArray[Any]]
    """Water, bed, maxima, edge flows, released quanta and gauge records, by name."""
    scalars: Mapping[str, float | int]
    """Time [s], step count, last time step [s], wave speed [m/s], initial and cut volume [m3], by name."""

    @property
    def nbytes(self) -> int:
        """Memory of the arrays."""
        return sum(array.nbytes for array in self.arrays.values())

    def check(self, shape: tuple[int, int], series_count: int, gauge_count: int) -> None:
        """Refuse a snapshot that does not belong to a model.

        Args:
            shape: (nrows, ncols) of the model.
            series_count: sources and rain of the model.
            gauge_count: gauges of the parameters.

        Raises:
            ModelError: naming what is missing or of another size.
        """
        for name in (*RASTERS, *OTHER_ARRAYS):
            if name not in self.arrays:
                raise ModelError(f"The snapshot lacks the array {name!r}.")
        for name in NUMBERS:
            if name not in self.scalars:
                raise ModelError(f"The snapshot lacks the number {name!r}.")
        for name in RASTERS:
            if self.arrays[name].shape != shape:
                found = self.arrays[name].shape
                raise ModelError(f"The snapshot's {name} has the shape {found}; the grid's is {shape}.")
        sources, gauges = self.arrays["released"].shape, self.arrays["gauge_records"].shape[1:]
        if sources != (series_count,) or gauges != (gauge_count, 4):
            raise ModelError("The snapshot belongs to a model with other sources, rain or gauges.")
