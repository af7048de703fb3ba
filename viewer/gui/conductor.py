"""What the window needs of the program behind it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from viewer.commands import Command, FlyTo
from viewer.view_status import ViewStatus
from viewer.world import MapView

__all__ = ["Conductor", "Dispatch", "Painter"]

Dispatch = Callable[[Command], None]


class Conductor(Protocol):
    """The state machine that carries out commands; `viewer.app.ViewerApp` is one."""

    def dispatch(self, command: Command) -> None:
        """Carry out a command; what goes wrong appears in the status message."""

    def advance(self, now: float) -> bool:
        """Move on to wall time `now` [s, monotonic]; return whether the picture has changed."""

    def status(self) -> ViewStatus:
        """Return the state to show."""

    def view_pose(self) -> FlyTo | None:
        """Return the command that brings back the present view; None without terrain."""

    def map_view(self) -> MapView | None:
        """Return the reference map, the same object while nothing on it has changed; None without terrain."""


class Painter(Protocol):
    """Draws the scene into whatever framebuffer is given; `viewer.app.Stage` is one."""

    def open(self) -> None:
        """Take the OpenGL context that is current.

        Raises:
            ContextError: it is not good enough.
        """

    @property
    def render_scale(self) -> float:
        """Pixels of the scene for each pixel of the picture, along one side."""

    def paint(self, framebuffer: int, width: int, height: int) -> None:
        """Draw the scene into framebuffer object `framebuffer` of that many pixels."""

    def ground_at(self, x: float, y: float) -> tuple[float, float] | None:
        """Return the map point [m] seen at pixel (x from the left, y from the top) of the last picture."""

    def close(self) -> None:
        """Release what was made in the context."""
