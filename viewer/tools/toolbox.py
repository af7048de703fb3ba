"""Sends each event to the tool it is for."""

from __future__ import annotations

from collections.abc import Sequence

from viewer.commands import Command, ReleaseMoves
from viewer.tools.edit_tool import EditTool
from viewer.tools.motion_keys import MotionKeys
from viewer.tools.orbit_tool import OrbitTool
from viewer.tools.pointer import PointerEvent

__all__ = ["Toolbox"]


class Toolbox:
    """The camera's tool, the edit tool and the motion keys behind one door."""

    def __init__(self) -> None:
        self.orbit = OrbitTool()
        self.edit = EditTool()
        self.keys = MotionKeys()

    def pointer(self, event: PointerEvent, *, is_drawing: bool) -> Sequence[Command]:
        """Return the commands for a pointer event; `is_drawing`: the edit tool is on."""
        if is_drawing and self.edit.wants(event):
            return self.edit.handle(event)
        return self.orbit.handle(event)

    def key_pressed(self, name: str, *, is_drawing: bool) -> Sequence[Command]:
        """Return the commands for a key that went down."""
        if is_drawing and (commands := self.edit.handle_key(name)):
            return commands
        return self.keys.press(name)

    def key_released(self, name: str) -> Sequence[Command]:
        """Return the commands for a key that went up."""
        return self.keys.release(name)

    def keyboard_lost(self) -> Sequence[Command]:
        """Return the commands for a window that lost the keyboard."""
        return [ReleaseMoves()]
