"""Click sets a point of what is measured, Esc puts the tool away."""

from __future__ import annotations

from viewer.commands import AddMeasurePoint, Command, EndMeasure, MoveHover
from viewer.tools.pointer import PointerEvent

__all__ = ["MeasureTool"]


class MeasureTool:
    """Measures with the left button; other buttons and the wheel stay with the camera."""

    def handle(self, event: PointerEvent) -> list[Command]:
        """Return what the event asks for."""
        if event.kind == "move":
            return [MoveHover(*event.ground)] if event.ground is not None else [MoveHover(None, None)]
        if event.kind == "press" and event.ground is not None:
            return [AddMeasurePoint(*event.ground)]
        return []

    def handle_key(self, name: str) -> list[Command]:
        """Return what a key ("escape") asks for while measuring."""
        return [EndMeasure()] if name == "escape" else []
