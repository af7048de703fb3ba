import pytest

from viewer.commands import (
    Command,
    CompareWith,
    PauseRun,
    Recalculate,
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
