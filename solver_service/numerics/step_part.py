"""What changes the water after the flux step: sources, rain, infiltration, structures.

Engines and solver know a part by this protocol alone. After every step each part is applied once, in a fixed
order, to the state that the step has written; what it changes it books. A part launches the same kernels
in every step, whatever the state, so that a CUDA graph can hold them, and it reads nothing back to the host.
Its sums have a fixed order: a run repeats bit for bit on every engine.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
import numpy.typing as npt
import warp as wp

from solver_service.numerics.fields import Fields


@dataclass(frozen=True)
class PartVolumes:
    """What a part has brought or taken since the start of the run [m3]."""

    rain: float = 0.0
    """Fallen as rain."""
    infiltration: float = 0.0
    """Gone into the ground."""
    edits: float = 0.0
    """Cut where the part raised the bed under water."""
    sources: Mapping[str, float] = field(default_factory=dict)
    """Brought by each source."""
    structures: Mapping[str, float] = field(default_factory=dict)
    """Taken out of the domain by each structure; negative for what it brought."""
    edges: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    """Come in and gone out through each edge segment."""
    moved: Mapping[str, float] = field(default_factory=dict)
    """Moved from place to place by each structure, which the budget of the whole does not see."""


class StepPart(Protocol):
    """Something that changes the water after the flux step."""

    @property
    def names(self) -> tuple[str, ...]:
        """Names of its arrays in a snapshot, unlike those of every other part."""

    @property
    def dt_max(self) -> float:
        """Largest time step it allows [s]; inf for any."""

    def cells(self) -> npt.NDArray[np.bool_]:
        """Cells that it may change even where nothing moves, [nrows, ncols]; their tiles never sleep."""

    def begin(self) -> None:
        """A run begins at time zero with new water."""

    def apply(self, clock: wp.array, fields: Fields) -> None:
        """Change `h_out`, `u_out`, `v_out` of `fields` for the step that has led to the clock's time.

        The clock may show a step of no length (see `kernel_engine`), in which nothing must change.
        """

    def volumes(self) -> PartVolumes:
        """What it has booked."""

    def snapshot(self) -> dict[str, npt.NDArray]:
        """Host copies of its arrays, by the names in `names`; their shapes depend on the model alone."""

    def restore(self, arrays: Mapping[str, npt.NDArray]) -> None:
        """Go on from the arrays of a snapshot, which are there and of the right shape."""
