"""Click adds a vertex of the edit line, double click or Enter finishes it, Esc drops it."""

from __future__ import annotations

from viewer.commands import AddVertex, CancelEdit, Command, FinishEdit, MoveHover
from viewer.tools.pointer import PointerEvent

__all__ = ["EditTool"]


class EditTool:
    """Draws on the ground with the left button; other buttons and the wheel stay with the camera."""

    def wants(self, event: PointerEvent) -> bool:
        """Whether the event is for drawing rather than for the camera."""
        return event.button == "left" or (event.kind == "move" and event.button == "none")

    def handle(self, event: PointerEvent) -> list[Command]:
        """Return what the event asks for."""
        if event.ground is None:
            return [MoveHover(None, None)] if event.kind == "move" else []
        if event.kind == "move":
            return [MoveHover(*event.ground)]
        if event.kind == "press":
            return [AddVertex(*event.ground)]
        if event.kind == "double":
            return [FinishEdit()]
        return []

    def handle_key(self, name: str) -> list[Command]:
        """Return what a key ("enter", "escape") asks for while drawing."""
        if name == "enter":
            return [FinishEdit()]
        if name == "escape":
            return [CancelEdit()]
        return []
