import pytest

from viewer.commands import (
    Command,
    DragOrbit,
    DragPan,
    FlyTo,
    GrabView,
    HoldMove,
    ReleaseMoves,
    ResetView,
    TopView,
    Zoom,
    command_from_mapping,
)


@pytest.mark.parametrize(
    ("entry", "command"),
    [
        ({"command": "GrabView", "on": True}, GrabView(True)),
        ({"command": "DragOrbit", "dx": 0.1, "dy": 0}, DragOrbit(0.1, 0.0)),
        ({"command": "DragPan", "dx": 0, "dy": -0.2}, DragPan(0.0, -0.2)),
        ({"command": "Zoom", "steps": 2}, Zoom(2.0, None, None)),
        ({"command": "HoldMove", "move": "north", "on": True}, HoldMove("north", True)),
        ({"command": "ReleaseMoves"}, ReleaseMoves()),
        ({"command": "FlyTo", "x": 1, "y": 2, "seconds": 0}, FlyTo(1.0, 2.0, seconds=0.0)),
        ({"command": "ResetView"}, ResetView()),
        ({"command": "TopView"}, TopView()),
    ],
)
def test_a_script_can_fly(entry: dict[str, object], command: Command) -> None:
    assert command_from_mapping(entry) == command
