"""Names of keys, as the tables of the tools have them."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtGui import QKeySequence

__all__ = ["key_name", "key_sequence", "name_of_key"]

_OTHER = {"return": "enter", "esc": "escape"}
_BACK = {name: key for key, name in _OTHER.items()}


def name_of_key(key: int) -> str:
    """Return the name of a key ("w", "left", "enter"); empty for one that has none."""
    if key in (Qt.Key.Key_Control, Qt.Key.Key_Shift, Qt.Key.Key_Alt, Qt.Key.Key_Meta, Qt.Key.Key_unknown):
        return ""
    return key_name(QKeySequence(key))


def key_name(sequence: QKeySequence) -> str:
    """Return the name of the one key of a sequence; empty for an empty one."""
    name = sequence.toString(QKeySequence.SequenceFormat.PortableText).lower()
    return _OTHER.get(name, name)


def key_sequence(name: str) -> QKeySequence:
    """Return the sequence of the one key of that name."""
    return QKeySequence(_BACK.get(name, name))
