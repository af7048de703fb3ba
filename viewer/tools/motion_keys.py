"""The keys that move the camera for as long as they are held."""

from __future__ import annotations

from collections.abc import Mapping

from viewer.commands import HoldMove
from viewer.tools.bindings import MOTION_KEYS

__all__ = ["MotionKeys"]


class MotionKeys:
    """Turns keys going down and up into moves beginning and ending."""

    def __init__(self, table: Mapping[str, str] = MOTION_KEYS) -> None:
        self._table = table

    def press(self, name: str) -> list[HoldMove]:
        """Return what the key `name` begins; nothing when it is no motion key."""
        return [HoldMove(self._table[name], True)] if name in self._table else []

    def release(self, name: str) -> list[HoldMove]:
        """Return what the key `name` ends."""
        return [HoldMove(self._table[name], False)] if name in self._table else []
