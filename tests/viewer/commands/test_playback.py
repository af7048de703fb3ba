import pytest

from viewer.commands import Command, FollowLive, Pause, Play, Seek, SetSpeed, TogglePlay, command_from_mapping


@pytest.mark.parametrize(
    ("entry", "command"),
    [
        ({"command": "Play"}, Play()),
        ({"command": "Pause"}, Pause()),
        ({"command": "TogglePlay"}, TogglePlay()),
        ({"command": "Seek", "time": 90}, Seek(90.0)),
        ({"command": "SetSpeed", "factor": 60}, SetSpeed(60.0)),
        ({"command": "FollowLive"}, FollowLive(True)),
        ({"command": "FollowLive", "on": False}, FollowLive(False)),
    ],
)
def test_a_script_can_play(entry: dict[str, object], command: Command) -> None:
    assert command_from_mapping(entry) == command
