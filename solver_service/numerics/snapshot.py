"""The exact state of a run between two steps: restored, it goes on bit for bit."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy.typing as npt

from solver_service.errors import ModelError

NUMBERS = ("time", "step_count", "dt", "wave_speed", "initial_volume", "edits_volume")


@dataclass(frozen=True)
class Snapshot:
    """Arrays and numbers of a state, in host memory; nothing in it is shared with the solver."""

    arrays: Mapping[str, npt.NDArray[Any]]
    """Water, bed, maxima, edge flows, gauge records and the arrays of each part of the step, by name."""
    scalars: Mapping[str, float | int]
    """Time [s], step count, last time step [s], wave speed [m/s], initial and cut volume [m3], by name."""

    @property
    def nbytes(self) -> int:
        """Memory of the arrays."""
        return sum(array.nbytes for array in self.arrays.values())

    def check(self, shapes: Mapping[str, tuple[int | None, ...]]) -> None:
        """Refuse a snapshot that does not belong to a model.

        Args:
            shapes: shape that each array must have, by name; None is any length.

        Raises:
            ModelError: naming what is missing or of another size.
        """
        for name in NUMBERS:
            if name not in self.scalars:
                raise ModelError(f"The snapshot lacks the number {name!r}.")
        for name, wanted in shapes.items():
            if name not in self.arrays:
                raise ModelError(f"The snapshot lacks the array {name!r} that the model needs.")
            found = self.arrays[name].shape
            fits = len(found) == len(wanted) and all(
                length is None or length == size for length, size in zip(wanted, found, strict=True)
            )
            if not fits:
                raise ModelError(f"The snapshot's {name} has the shape {found}; the model's is {wanted}.")
