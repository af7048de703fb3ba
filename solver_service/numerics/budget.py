"""The volume budget: what was there, what came, what left, what is there.

    error = stored - (initial + inflow + rain - outflow - edits)

All sums are float64 and in a fixed order. Outflow is summed per edge face from the very fluxes that moved
the water.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solver_service.numerics.fields import FieldStore


@dataclass(frozen=True)
class VolumeBudget:
    """Volumes since the start of the run [m3]."""

    initial: float
    """Water at the start."""
    stored: float
    """Water now."""
    inflow: float
    """Brought by sources."""
    outflow: float
    """Left through open edges."""
    rain: float
    """Brought by rain."""
    edits: float
    """Cut by raising the bed under water."""

    @property
    def error(self) -> float:
        """Volume that nothing explains [m3]."""
        return self.stored - (self.initial + self.inflow + self.rain - self.outflow - self.edits)

    @property
    def error_relative(self) -> float:
        """Error in units of all the water there ever was [1]."""
        turnover = self.initial + self.inflow + self.rain
        return self.error / turnover if turnover > 0.0 else 0.0


def stored_volume(store: FieldStore, dx: float) -> float:
    """Water on the grid [m3]."""
    return float(store.interior("h").sum(dtype=np.float64)) * dx * dx


def edge_outflow(store: FieldStore, dx: float) -> float:
    """Water that left through the edges [m3]."""
    return float(store.edge_flow.numpy().sum()) * dx * dx
