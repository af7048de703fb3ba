"""The volume budget: what was there, what came, what left, what is there.

    error = stored - (initial + inflow + rain - infiltration - outflow - edits)

All sums are float64 and in a fixed order. What passes an edge is summed per face from the very fluxes that
moved the water; everything else is booked by the part of the step that moved it (see `step_part`).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np

from solver_service.numerics.fields import FieldStore
from solver_service.numerics.step_part import PartVolumes


@dataclass(frozen=True)
class VolumeBudget:
    """Volumes since the start of the run [m3]."""

    initial: float
    """Water at the start."""
    stored: float
    """Water now."""
    rain: float = 0.0
    """Brought by rain."""
    infiltration: float = 0.0
    """Gone into the ground."""
    edits: float = 0.0
    """Cut by raising the bed under water."""
    sources: Mapping[str, float] = field(default_factory=dict)
    """Brought by each source."""
    edges: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    """Come in and gone out through each edge segment."""
    structures: Mapping[str, float] = field(default_factory=dict)
    """Taken out of the domain by each structure; negative for what it brought."""
    moved: Mapping[str, float] = field(default_factory=dict)
    """Moved within the domain by each structure; not part of the balance."""

    @property
    def inflow(self) -> float:
        """Brought by sources, edges and structures."""
        edges = sum(came for came, _ in self.edges.values())
        structures = sum(-taken for taken in self.structures.values() if taken < 0.0)
        return sum(self.sources.values()) + edges + structures

    @property
    def outflow(self) -> float:
        """Left through edges and structures."""
        edges = sum(left for _, left in self.edges.values())
        return edges + sum(taken for taken in self.structures.values() if taken > 0.0)

    @property
    def error(self) -> float:
        """Volume that nothing explains."""
        came = self.initial + self.inflow + self.rain
        return self.stored - (came - self.infiltration - self.outflow - self.edits)

    @property
    def error_relative(self) -> float:
        """Error in units of all the water there ever was [1]."""
        turnover = self.initial + self.inflow + self.rain
        return self.error / turnover if turnover > 0.0 else 0.0

    def as_dict(self) -> dict[str, Any]:
        """Everything by name, as plain numbers: for summaries and streams."""
        return asdict(self) | {
            "edges": {name: {"in": came, "out": left} for name, (came, left) in self.edges.items()},
            "inflow": self.inflow,
            "outflow": self.outflow,
            "error": self.error,
            "error_relative": self.error_relative,
        }


def stored_volume(store: FieldStore, dx: float) -> float:
    """Water on the grid [m3]."""
    return float(store.interior("h").sum(dtype=np.float64)) * dx * dx


def close_budget(
    initial: float,
    stored: float,
    edits: float,
    parts: Iterable[PartVolumes],
) -> VolumeBudget:
    """The budget of a run from what each part of the step has booked [m3]."""
    booked = list(parts)
    return VolumeBudget(
        initial=initial,
        stored=stored,
        rain=sum(part.rain for part in booked),
        infiltration=sum(part.infiltration for part in booked),
        edits=edits + sum(part.edits for part in booked),
        sources={name: volume for part in booked for name, volume in part.sources.items()},
        edges={name: volumes for part in booked for name, volumes in part.edges.items()},
        structures={name: volume for part in booked for name, volume in part.structures.items()},
        moved={name: volume for part in booked for name, volume in part.moved.items()},
    )
