"""One pointer event, free of any toolkit."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

__all__ = ["Button", "Drag", "PointerEvent", "PointerKind"]

CLICK_SHARE = 0.006
"""A press and release nearer than this share of the picture height are a click."""

PointerKind = Literal["press", "move", "release", "double", "wheel", "scroll", "leave"]
Button = Literal["left", "middle", "right", "none"]


@dataclass(frozen=True)
class PointerEvent:
    """What the pointer did.

    Attributes:
        kind: press, move, release, double (second press of a double click), wheel, scroll (two fingers) or
            leave.
        x: distance from the left edge of the picture, in picture heights.
        y: distance from its top edge, in picture heights.
        button: the button that went down or up, or is held while moving.
        shift: whether shift is held.
        steps: wheel notches, positive away from the user.
        dx: how far two fingers went to the right, in picture heights.
        dy: how far they went down.
        ground: map coordinates (x, y) [m] of what is seen under the pointer; None: the sky, or not looked up.
    """

    kind: PointerKind
    x: float
    y: float
    button: Button = "none"
    shift: bool = False
    steps: float = 0.0
    ground: tuple[float, float] | None = None
    dx: float = 0.0
    dy: float = 0.0


class Drag:
    """Tells a drag from a click: the pointer has left the place of the press while the button was held."""

    def __init__(self) -> None:
        self._from: tuple[float, float] | None = None
        self._is_drag = False

    def begin(self, event: PointerEvent) -> None:
        """The button went down."""
        self._from, self._is_drag = (event.x, event.y), False

    def follow(self, event: PointerEvent) -> bool:
        """The pointer has moved; return whether this is a drag."""
        if self._from is not None:
            away = abs(event.x - self._from[0]) + abs(event.y - self._from[1])
            self._is_drag = self._is_drag or away >= CLICK_SHARE
        return self._is_drag

    def end(self) -> bool:
        """The button went up; return whether it was a drag."""
        was_drag, self._from, self._is_drag = self._is_drag, None, False
        return was_drag
