"""Left drag turns the camera, right or middle drag (or shift and left) moves it, the wheel comes nearer."""

from __future__ import annotations

from viewer.commands import Command, DragOrbit, DragPan, GrabView, MoveHover, ProbeAt, Zoom
from viewer.tools.pointer import CLICK_SHARE, PointerEvent

__all__ = ["OrbitTool"]


class OrbitTool:
    """The tool that is on when no other is; a click without a drag probes the point."""

    def __init__(self) -> None:
        self._last: tuple[float, float] | None = None
        self._travelled = 0.0

    def handle(self, event: PointerEvent) -> list[Command]:
        """Return what the event asks for."""
        if event.kind == "wheel":
            return [Zoom(event.steps, *(event.ground or (None, None)))]
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
        if event.button == "left" and not event.shift:
            return [DragOrbit(dx, dy)]
        return [DragPan(dx, dy)]

    def _released(self, event: PointerEvent) -> list[Command]:
        is_click = self._last is not None and self._travelled < CLICK_SHARE
        self._last = None
        commands: list[Command] = [GrabView(False)]
        if is_click and event.button == "left" and event.ground is not None:
            commands.append(ProbeAt(*event.ground))
        return commands
