import dataclasses

import pytest

from viewer import commands
from viewer.commands import CommandError, FlyTo, Play, Seek, SetOption, StartRun, command_from_mapping

EVERY_COMMAND = commands.Command.__args__


def test_a_script_entry_becomes_the_command_it_names() -> None:
    assert command_from_mapping({"command": "Seek", "time": 120}) == Seek(120.0)
    assert command_from_mapping({"command": "Play"}) == Play()
    assert command_from_mapping({"command": "StartRun", "case": "jacksboro"}) == StartRun("jacksboro")
    assert command_from_mapping({"command": "SetOption", "name": "wireframe", "value": True}) == SetOption(
        "wireframe", True
    )
    assert command_from_mapping({"command": "FlyTo", "x": 1, "y": 2, "distance": None}) == FlyTo(1.0, 2.0)


@pytest.mark.parametrize(
    ("entry", "complaint"),
    [
        ({"command": "Fly"}, "'Fly' is unknown"),
        ({"command": 3}, "unknown"),
        ({}, "unknown"),
        ({"command": "Seek"}, "'time' is missing"),
        ({"command": "Seek", "time": "soon"}, "must be float"),
        ({"command": "Seek", "time": float("nan")}, "finite"),
        ({"command": "Seek", "time": True}, "must be float"),
        ({"command": "Seek", "time": 1.0, "speed": 2.0}, "'speed' is unknown"),
        ({"command": "StartRun", "case": 7}, "must be str"),
        ({"command": "__class__"}, "unknown"),
    ],
)
def test_a_wrong_entry_is_refused_in_one_sentence(entry: dict[str, object], complaint: str) -> None:
    with pytest.raises(CommandError, match=complaint):
        command_from_mapping(entry)


@pytest.mark.parametrize("kind", EVERY_COMMAND)
def test_every_command_is_frozen_and_listed(kind: type) -> None:
    assert dataclasses.is_dataclass(kind)
    assert kind.__dataclass_params__.frozen  # type: ignore[attr-defined]
    assert kind.__name__ in commands.__all__


def test_every_listed_command_can_be_carried_out() -> None:
    listed = {name for name in commands.__all__ if name[0].isupper()} - {"Command", "CommandError"}

    assert listed == {kind.__name__ for kind in EVERY_COMMAND}
