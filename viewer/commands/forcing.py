"""Forcing: what drives the flood from outside, changed for the next branch."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["ChangeForcing", "ResetForcing"]


@dataclass(frozen=True)
class ChangeForcing:
    """Change one item of the forcing of the shown run; None leaves what it says as it is.

    Attributes:
        item: id of a source, an edge or a breach, or "rain".
        factor: what its values are multiplied by.
        offset: what is added to a level [m].
        series_file: CSV file with the series that takes the place of the case's; empty for the case's again.
        start: when a breach begins [s], "never", or "case" for what the case says.
    """

    item: str
    factor: float | None = None
    offset: float | None = None
    series_file: str | None = None
    start: float | str | None = None


@dataclass(frozen=True)
class ResetForcing:
    """Let one item (None: all of them) be as the case says."""

    item: str | None = None


ForcingCommand = ChangeForcing | ResetForcing
"""Any command of this family."""
