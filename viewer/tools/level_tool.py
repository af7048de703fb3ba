"""A click says the level of the crest: that of the water there, or of the ground."""

from __future__ import annotations

from viewer.commands import CancelEdit, Command, MoveHover, TakeLevel
from viewer.tools.pointer import PointerEvent

__all__ = ["LevelTool"]


class LevelTool:
    """Takes one click of the left button; other buttons and the wheel stay with the camera."""

    def handle(self, event: PointerEvent) -> list[Command]:
        """Return what the event asks for."""
        if event.kind == "press" and event.ground is not None:
            return [TakeLevel(*event.ground)]
        if event.kind == "move" and event.button == "none":
            return [MoveHover(None, None) if event.ground is None else MoveHover(*event.ground)]
        return []

    def handle_key(self, name: str) -> list[Command]:
        """Return what a key asks for: "escape" takes no level."""
        return [CancelEdit()] if name == "escape" else []
