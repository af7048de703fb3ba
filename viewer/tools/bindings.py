"""What keys and mouse do, as tables that people can change."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any, Literal, get_args

__all__ = ["DRAGS", "MOTION_KEYS", "SCROLLS", "WHEELS", "Bindings", "Drag", "MouseTable"]

Drag = Literal["orbit", "pan", "zoom"]
Wheel = Literal["nearer", "farther"]
Scroll = Literal["zoom", "pan", "orbit"]
DRAGS: tuple[str, ...] = get_args(Drag)
WHEELS: tuple[str, ...] = get_args(Wheel)
SCROLLS: tuple[str, ...] = get_args(Scroll)

MOTION_KEYS: Mapping[str, str] = MappingProxyType(
    {
        "w": "pan_forward",
        "s": "pan_back",
        "a": "pan_left",
        "d": "pan_right",
        "left": "orbit_left",
        "right": "orbit_right",
        "up": "orbit_up",
        "down": "orbit_down",
        "q": "zoom_out",
        "e": "zoom_in",
    }
)
"""Key name to the name of a `viewer.world.Move`."""


@dataclass(frozen=True)
class MouseTable:
    """What drags and the wheel do.

    Attributes:
        left: what a drag with the left button does: "orbit", "pan" or "zoom".
        middle: the middle button.
        right: the right button.
        shift_left: the left button while shift is held.
        wheel: what turning the wheel away from the user does: come "nearer", or go "farther".
        scroll: what two fingers on a trackpad do: "zoom", "pan" or "orbit".
    """

    left: str = "orbit"
    middle: str = "pan"
    right: str = "pan"
    shift_left: str = "pan"
    wheel: str = "nearer"
    scroll: str = "pan"

    def drag(self, button: str, shift: bool) -> str:
        """What a drag with a button does."""
        if button == "left":
            return self.shift_left if shift else self.left
        return self.middle if button == "middle" else self.right


_ALLOWED = {
    "left": DRAGS,
    "middle": DRAGS,
    "right": DRAGS,
    "shift_left": DRAGS,
    "wheel": WHEELS,
    "scroll": SCROLLS,
}


@dataclass(frozen=True)
class Bindings:
    """All tables.

    Attributes:
        mouse: drags and the wheel.
        keys: key name to the motion of the camera while it is held.
        shortcuts: name of a menu entry to its key sequence, for those that are not as they came.
    """

    mouse: MouseTable = MouseTable()
    keys: Mapping[str, str] = field(default_factory=lambda: MOTION_KEYS)
    shortcuts: Mapping[str, str] = field(default_factory=dict)

    def as_mapping(self) -> dict[str, Any]:
        """Return the tables as plain values."""
        return {
            "mouse": {name: getattr(self.mouse, name) for name in _ALLOWED},
            "keys": dict(self.keys),
            "shortcuts": dict(self.shortcuts),
        }

    @classmethod
    def from_mapping(cls, raw: Mapping[str, Any]) -> Bindings:
        """Return the tables that `as_mapping` wrote; what is not valid stays as it came."""
        mouse = {
            name: value for name, value in _texts(raw.get("mouse")).items() if value in _ALLOWED.get(name, ())
        }
        moves = set(MOTION_KEYS.values())
        keys = {key: move for key, move in _texts(raw.get("keys")).items() if key and move in moves}
        is_whole = set(keys.values()) == moves
        return cls(MouseTable(**mouse), keys if is_whole else MOTION_KEYS, _texts(raw.get("shortcuts")))


def _texts(raw: object) -> dict[str, str]:
    if not isinstance(raw, dict):
        return {}
    return {key: value for key, value in raw.items() if isinstance(key, str) and isinstance(value, str)}
