"""The camera: dragging, flying, looking from above. Positions are map coordinates [m]."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = [
    "DragOrbit",
    "DragPan",
    "FlyTo",
    "GrabView",
    "HoldMove",
    "ReleaseMoves",
    "ResetView",
    "TopView",
    "Zoom",
]


@dataclass(frozen=True)
class GrabView:
    """The pointer has taken hold of the view (`on`) or let it go; let go, the camera coasts to rest."""

    on: bool


@dataclass(frozen=True)
class DragOrbit:
    """Turn the camera about its target by a drag of (dx, dy) picture heights (x right, y down)."""

    dx: float
    dy: float


@dataclass(frozen=True)
class DragPan:
    """Move the ground by a drag of (dx, dy) picture heights (x right, y down)."""

    dx: float
    dy: float


@dataclass(frozen=True)
class Zoom:
    """Come nearer by `steps` wheel notches (negative: go away).

    The ground point (x, y) [m] keeps its place in the picture; None: the point looked at does.
    """

    steps: float
    x: float | None = None
    y: float | None = None


@dataclass(frozen=True)
class HoldMove:
    """A motion key went down (`on`) or up; `move` is the lower-case name of a `viewer.world.Move`."""

    move: str
    on: bool


@dataclass(frozen=True)
class ReleaseMoves:
    """No motion key is held any more: the window lost the keyboard."""


@dataclass(frozen=True)
class FlyTo:
    """Glide to look at (x, y) [m] from `distance` [m], in `seconds` of wall time (0: be there at once).

    `azimuth` and `elevation` are in degrees. Azimuth is the compass bearing in which the camera looks (0 =
    to the north, 90 = to the east), elevation
    the height of the eye above the horizon; None keeps the present value.
    """

    x: float
    y: float
    distance: float | None = None
    azimuth: float | None = None
    elevation: float | None = None
    seconds: float = 1.0


@dataclass(frozen=True)
class ResetView:
    """Show the whole terrain from the south."""


@dataclass(frozen=True)
class TopView:
    """Show the whole terrain from straight above, north up."""


CameraCommand = GrabView | DragOrbit | DragPan | Zoom | HoldMove | ReleaseMoves | FlyTo | ResetView | TopView
"""Any command of this family."""
