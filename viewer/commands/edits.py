"""Terrain edits: the tool, the line being drawn, the working list. Positions are map coordinates [m]."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["AddVertex", "BeginEdit", "CancelEdit", "ChangeEditSettings", "FinishEdit", "Redo", "Undo"]


@dataclass(frozen=True)
class ChangeEditSettings:
    """What the next edit will be; None leaves a setting as it is.

    Attributes:
        width: width of the line [m].
        magnitude: height of the change [m].
        operation: "raise" or "lower".
        type: "modulate" (add to the ground) or "replace" (a crest or a floor along the line).
    """

    width: float | None = None
    magnitude: float | None = None
    operation: str | None = None
    type: str | None = None


@dataclass(frozen=True)
class BeginEdit:
    """Start drawing an edit line; the edit tool is on until it is finished or cancelled."""


@dataclass(frozen=True)
class AddVertex:
    """Add the ground point (x, y) [m] to the line being drawn."""

    x: float
    y: float


@dataclass(frozen=True)
class FinishEdit:
    """Take the drawn line into the list of edits."""


@dataclass(frozen=True)
class CancelEdit:
    """Drop the line being drawn and put the edit tool away."""


@dataclass(frozen=True)
class Undo:
    """Take back the newest edit of the working list."""


@dataclass(frozen=True)
class Redo:
    """Bring the edit taken back last."""
