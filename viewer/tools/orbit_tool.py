"""The camera by mouse and trackpad: drags, the wheel, two fingers, each as a table says."""

from __future__ import annotations

from viewer.commands import Command, DragOrbit, DragPan, GrabView, MoveHover, ProbeAt, Zoom
from viewer.tools.bindings import MouseTable
from viewer.tools.pointer import CLICK_SHARE, PointerEvent

__all__ = ["OrbitTool"]

ZOOM_STEPS = 12.0
"""Wheel notches that a drag over the height of the picture is worth."""


class OrbitTool:
    """The tool that is on when no other is; a click without a drag probes the point.

    Attributes:
        table: what drags, the wheel and two fingers do.
    """

    def __init__(self, table: MouseTable | None = None) -> None:
        self.table = MouseTable() if table is None else table
        self._last: tuple[float, float] | None = None
        self._travelled = 0.0

    def handle(self, event: PointerEvent) -> list[Command]:
        """Return what the event asks for."""
        if event.kind == "wheel":
            steps = event.steps if self.table.wheel == "nearer" else -event.steps
            return [Zoom(steps, *(event.ground or (None, None)))]
        if event.kind == "scroll":
            return self._drag(self.table.scroll, event.dx, event.dy)
        if event.kind == "leave":
            return [MoveHover(None, None)]
        if event.kind in ("press", "double"):
            self._last, self._travelled = (event.x, event.y), 0.0
            return [GrabView(True)]
        if event.kind == "release":
            return self._released(event)
        if self._last is None:
            return [MoveHover(*event.ground)] if event.ground is not None else [MoveHover(None, None)]
        dx, dy = event.x - self._last[0], event.y - self._last[1]
        self._last = (event.x, event.y)
        self._travelled += abs(dx) + abs(dy)
        return self._drag(self.table.drag(event.button, event.shift), dx, dy)

    def _drag(self, what: str, dx: float, dy: float) -> list[Command]:
        if what == "zoom":
            return [Zoom(-ZOOM_STEPS * dy)]
        return [DragOrbit(dx, dy)] if what == "orbit" else [DragPan(dx, dy)]

    def _released(self, event: PointerEvent) -> list[Command]:
        is_click = self._last is not None and self._travelled < CLICK_SHARE
        self._last = None
        commands: list[Command] = [GrabView(False)]
        if is_click and event.button == "left" and event.ground is not None:
            commands.append(ProbeAt(*event.ground))
        return commands
