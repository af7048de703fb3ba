"""The picture: its options, the point under the pointer, writing it to a file."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["MoveHover", "ProbeAt", "SavePicture", "SetOption", "ShowSeries"]


@dataclass(frozen=True)
class MoveHover:
    """The pointer is over the ground point (x, y) [m], or over nothing; readout and rubber band follow."""

    x: float | None
    y: float | None


@dataclass(frozen=True)
class ProbeAt:
    """Keep a depth record at the ground point (x, y) [m]."""

    x: float
    y: float


@dataclass(frozen=True)
class ShowSeries:
    """Show what a gauge or section of the shown run records; None shows the probed point again.

    Attributes:
        id: the gauge's or section's name.
        kind: "gauge" or "section" where both have that name; empty for either.
    """

    id: str | None
    kind: str = ""


@dataclass(frozen=True)
class SetOption:
    """Set a view option (see `viewer.render.ViewOptions`) by name."""

    name: str
    value: bool | float | str


@dataclass(frozen=True)
class SavePicture:
    """Write the picture now shown to `path` (PNG), drawn anew with smooth edges.

    Attributes:
        path: where to.
        width: width of the file [pixels]; None takes the window's.
        height: its height [pixels]; None takes the window's.
        with_text: whether title, legend, scale bar and north arrow are written on it.
    """

    path: str
    width: float | None = None
    height: float | None = None
    with_text: bool = True


PictureCommand = MoveHover | ProbeAt | ShowSeries | SetOption | SavePicture
"""Any command of this family."""
