"""Figures that the validation tests measure: each is asserted once and listed in ``docs/validation.md``."""

from dataclasses import dataclass

import pytest


@dataclass(frozen=True)
class Figure:
    """One measured number of one case.

    Attributes:
        case: Heading of the case in the table.
        quantity: What was measured, with the grid where it matters.
        value: The measured number.
        unit: Its unit, empty for a ratio.
        below: Largest value that passes; None where only reported or bounded from below.
        above: Smallest value that passes.
        yardstick: The same error of the published scheme on the same grid, or a number in print.
        instead: What the table shows instead of a value that differs from machine to machine.
    """

    case: str
    quantity: str
    value: float
    unit: str = ""
    below: float | None = None
    above: float | None = None
    yardstick: float | None = None
    instead: str = ""

    @property
    def passes(self) -> bool:
        """Whether the value keeps its bounds; a NaN never does."""
        return (self.below is None or self.value <= self.below) and (
            self.above is None or self.value >= self.above
        )


FIGURES = pytest.StashKey[list[Figure]]()
