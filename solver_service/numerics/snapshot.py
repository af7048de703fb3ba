"""The exact state of a run between two steps: restored, it goes on bit for bit."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt


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


@dataclass(frozen=True)
class Maxima:
    """The largest values since the start, each taken after every step; rasters [nrows, ncols]."""

    h: npt.NDArray[np.float32]
    """Depth [m]."""
    time_of_max: npt.NDArray[np.float32]
    """Time of the largest depth [s], NaN where it stayed dry."""
    speed: npt.NDArray[np.float32]
    """Speed [m/s], where h > 0.05 m."""
    unit_discharge: npt.NDArray[np.float32]
    """Depth times speed [m2/s]."""
    hazard: npt.NDArray[np.float32]
    """UK hazard rating h (speed + 0.5) + debris factor."""
    arrival_time: npt.NDArray[np.float32]
    """First time deeper than `depth_arrival` [s], NaN where never."""
