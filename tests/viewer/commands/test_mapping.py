import pytest

from viewer.commands import CommandError, FlyTo, Play, Seek, SetOption, StartRun, command_from_mapping


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
