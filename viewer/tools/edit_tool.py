"""Click adds a vertex, a drag draws free-hand, double click or Enter finishes, Backspace and Esc drop."""

from __future__ import annotations

from viewer.commands import (
    AddVertex,
    CancelEdit,
    Command,
    DropVertex,
    EndStroke,
    FinishEdit,
    MoveHover,
    StrokeTo,
)
from viewer.tools.pointer import Drag, PointerEvent

__all__ = ["EditTool"]

_KEYS: dict[str, Command] = {"enter": FinishEdit(), "escape": CancelEdit(), "backspace": DropVertex()}


class EditTool:
    """Draws on the ground with the left button; other buttons and the wheel stay with the camera."""

    def __init__(self) -> None:
        self._drag = Drag()

    def handle(self, event: PointerEvent) -> list[Command]:
        """Return what the event asks for."""
        if event.kind == "press":
            self._drag.begin(event)
            return [] if event.ground is None else [AddVertex(*event.ground)]
        if event.kind == "double":
            return [FinishEdit()]
        if event.kind == "release":
            return self._released(event)
        if event.button == "left":
            is_stroke = self._drag.follow(event)
            return [StrokeTo(*event.ground)] if is_stroke and event.ground is not None else []
        return [MoveHover(None, None) if event.ground is None else MoveHover(*event.ground)]

    def handle_key(self, name: str) -> list[Command]:
        """Return what a key ("enter", "escape", "backspace") asks for while drawing."""
        return [_KEYS[name]] if name in _KEYS else []

    def _released(self, event: PointerEvent) -> list[Command]:
        if not self._drag.end():
            return []
        return [EndStroke()] if event.ground is None else [StrokeTo(*event.ground), EndStroke()]
