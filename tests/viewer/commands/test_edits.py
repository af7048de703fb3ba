import pytest

from viewer.commands import (
    AddVertex,
    BeginEdit,
    CancelEdit,
    ChangeEditSettings,
    Command,
    FinishEdit,
    Redo,
    Undo,
    command_from_mapping,
)


@pytest.mark.parametrize(
    ("entry", "command"),
    [
        ({"command": "BeginEdit"}, BeginEdit()),
        ({"command": "AddVertex", "x": 1, "y": 2.5}, AddVertex(1.0, 2.5)),
        ({"command": "FinishEdit"}, FinishEdit()),
        ({"command": "CancelEdit"}, CancelEdit()),
        ({"command": "Undo"}, Undo()),
        ({"command": "Redo"}, Redo()),
        (
            {"command": "ChangeEditSettings", "width": 30, "operation": "lower"},
            ChangeEditSettings(width=30.0, operation="lower"),
        ),
    ],
)
def test_a_script_can_edit_the_terrain(entry: dict[str, object], command: Command) -> None:
    assert command_from_mapping(entry) == command
