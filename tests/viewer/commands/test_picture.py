import pytest

from viewer.commands import (
    Command,
    MoveHover,
    ProbeAt,
    SavePicture,
    SetOption,
    ShowSeries,
    command_from_mapping,
)


@pytest.mark.parametrize(
    ("entry", "command"),
    [
        ({"command": "MoveHover", "x": None, "y": None}, MoveHover(None, None)),
        ({"command": "ProbeAt", "x": 1, "y": 2}, ProbeAt(1.0, 2.0)),
        ({"command": "SetOption", "name": "tau_px", "value": 3}, SetOption("tau_px", 3.0)),
        ({"command": "ShowSeries", "id": "town"}, ShowSeries("town")),
        ({"command": "ShowSeries", "id": None}, ShowSeries(None)),
        ({"command": "SavePicture", "path": "flood.png"}, SavePicture("flood.png")),
    ],
)
def test_a_script_can_change_the_picture(entry: dict[str, object], command: Command) -> None:
    assert command_from_mapping(entry) == command
