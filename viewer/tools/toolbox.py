"""Sends each event to the tool it is for."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from viewer.commands import Command, ReleaseMoves
from viewer.tools.bindings import Bindings
from viewer.tools.edit_tool import EditTool
from viewer.tools.level_tool import LevelTool
from viewer.tools.measure_tool import MeasureTool
from viewer.tools.motion_keys import MotionKeys
from viewer.tools.orbit_tool import OrbitTool
from viewer.tools.pointer import PointerEvent
from viewer.tools.select_tool import SelectTool

__all__ = ["Toolbox"]


class _HandTool(Protocol):
    """A tool that has the left button and the bare pointer while it is in hand."""

    def handle(self, event: PointerEvent) -> list[Command]:
        """Return what the event asks for."""

    def handle_key(self, name: str) -> list[Command]:
        """Return what a key asks for; nothing when it is for others."""


class Toolbox:
    """The camera's tool, the other tools by name and the motion keys behind one door."""

    def __init__(self) -> None:
        self.orbit = OrbitTool()
        self.keys = MotionKeys()
        drawing = EditTool()
        self._tools: dict[str, _HandTool] = {
            "line": drawing,
            "area": drawing,
            "select": SelectTool(),
            "level": LevelTool(),
            "measure": MeasureTool(),
        }

    def bind(self, bindings: Bindings) -> None:
        """Let keys and mouse do what the tables say."""
        self.orbit.table = bindings.mouse
        self.keys = MotionKeys(bindings.keys)

    def pointer(self, event: PointerEvent, *, tool: str = "") -> Sequence[Command]:
        """Return the commands for a pointer event; `tool`: the name of the tool in hand."""
        is_free = event.kind == "move" and event.button == "none"
        if tool in self._tools and (event.button == "left" or is_free):
            return self._tools[tool].handle(event)
        return self.orbit.handle(event)

    def key_pressed(self, name: str, *, tool: str = "") -> Sequence[Command]:
        """Return the commands for a key that went down."""
        if tool in self._tools and (commands := self._tools[tool].handle_key(name)):
            return commands
        return self.keys.press(name)

    def key_released(self, name: str) -> Sequence[Command]:
        """Return the commands for a key that went up."""
        return self.keys.release(name)

    def keyboard_lost(self) -> Sequence[Command]:
        """Return the commands for a window that lost the keyboard."""
        return [ReleaseMoves()]
