import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QKeySequence

from viewer.gui.key_names import key_name, key_sequence, name_of_key
from viewer.tools.bindings import MOTION_KEYS


@pytest.mark.parametrize(
    ("key", "name"),
    [
        (Qt.Key.Key_W, "w"),
        (Qt.Key.Key_Left, "left"),
        (Qt.Key.Key_Return, "enter"),
        (Qt.Key.Key_Enter, "enter"),
        (Qt.Key.Key_Escape, "escape"),
        (Qt.Key.Key_Backspace, "backspace"),
        (Qt.Key.Key_Shift, ""),
        (Qt.Key.Key_unknown, ""),
    ],
)
def test_keys_have_the_names_of_the_tools(key: Qt.Key, name: str) -> None:
    assert name_of_key(key) == name


@pytest.mark.parametrize("name", [*MOTION_KEYS, "escape", "enter", "f5"])
def test_a_name_is_a_key_and_back(name: str) -> None:
    assert key_name(key_sequence(name)) == name
    assert not key_sequence(name).isEmpty()


def test_no_key_has_no_name() -> None:
    assert key_name(QKeySequence()) == ""
