import pytest

from viewer.commands import (
    Command,
    CompareWith,
    ConnectTo,
    PauseRun,
    Recalculate,
    Reconnect,
    ResumeRun,
    SelectRun,
    StartRun,
    StopRun,
    command_from_mapping,
)


@pytest.mark.parametrize(
    ("entry", "command"),
    [
        ({"command": "StartRun", "case": "valley", "duration": 60}, StartRun("valley", 60.0)),
        ({"command": "SelectRun", "run": "a"}, SelectRun("a")),
        ({"command": "CompareWith"}, CompareWith(None)),
        ({"command": "PauseRun"}, PauseRun(None)),
        ({"command": "ResumeRun", "run": "a"}, ResumeRun("a")),
        ({"command": "StopRun", "run": None}, StopRun(None)),
        ({"command": "Recalculate"}, Recalculate()),
    ],
)
def test_a_script_can_steer_runs(entry: dict[str, object], command: Command) -> None:
    assert command_from_mapping(entry) == command


def test_a_script_can_change_the_service() -> None:
    entry = {"command": "ConnectTo", "url": "ws://there", "token_file": "token.txt"}

    assert command_from_mapping(entry) == ConnectTo("ws://there", "token.txt")
    assert command_from_mapping({"command": "Reconnect"}) == Reconnect()
