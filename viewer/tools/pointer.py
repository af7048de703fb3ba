"""One pointer event, free of any toolkit."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

__all__ = ["Button", "PointerEvent", "PointerKind"]

PointerKind = Literal["press", "move", "release", "double", "wheel", "leave"]
Button = Literal["left", "middle", "right", "none"]


@dataclass(frozen=True)
class PointerEvent:
    """What the pointer did.

    Attributes:
        kind: press, move, release, double (second press of a double click), wheel or leave.
        x: distance from the left edge of the picture, in picture heights.
        y: distance from its top edge, in picture heights.
        button: the button that went down or up, or is held while moving.
        shift: whether shift is held.
        steps: wheel notches, positive away from the user.
        ground: map coordinates (x, y) [m] of what is seen under the pointer; None: the sky, or not looked up.
    """

    kind: PointerKind
    x: float
    y: float
    button: Button = "none"
    shift: bool = False
    steps: float = 0.0
    ground: tuple[float, float] | None = None
