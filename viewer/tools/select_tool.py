"""Click selects an edit; a drag moves it, or the vertex it began on."""

from __future__ import annotations

from viewer.commands import CancelEdit, Command, DragEdit, DropEdit, GrabEdit, MoveHover, SelectEdit
from viewer.tools.pointer import Drag, PointerEvent

__all__ = ["SelectTool"]


class SelectTool:
    """Moves edits with the left button; other buttons and the wheel stay with the camera."""

    def __init__(self) -> None:
        self._drag = Drag()

    def handle(self, event: PointerEvent) -> list[Command]:
        """Return what the event asks for."""
        if event.kind in ("press", "double"):
            self._drag.begin(event)
            return [SelectEdit(None) if event.ground is None else GrabEdit(*event.ground)]
        if event.kind == "release":
            was_drag = self._drag.end()
            moves = [DragEdit(*event.ground)] if was_drag and event.ground is not None else []
            return [*moves, DropEdit()]
        if event.button == "left":
            is_drag = self._drag.follow(event)
            return [DragEdit(*event.ground)] if is_drag and event.ground is not None else []
        return [MoveHover(None, None) if event.ground is None else MoveHover(*event.ground)]

    def handle_key(self, name: str) -> list[Command]:
        """Return what a key asks for: "escape" leaves what is moved where it was and puts the tool away."""
        return [CancelEdit()] if name == "escape" else []
