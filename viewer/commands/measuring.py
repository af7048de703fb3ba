"""Measuring distances and areas on the ground. Positions are map coordinates [m]."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["AddMeasurePoint", "BeginMeasure", "EndMeasure"]


@dataclass(frozen=True)
class BeginMeasure:
    """Take the measuring tool; what was measured before is dropped."""


@dataclass(frozen=True)
class AddMeasurePoint:
    """Add the ground point (x, y) [m] to what is measured."""

    x: float
    y: float


@dataclass(frozen=True)
class EndMeasure:
    """Put the measuring tool away, and the line with it."""


MeasuringCommand = BeginMeasure | AddMeasurePoint | EndMeasure
"""Any command of this family."""
