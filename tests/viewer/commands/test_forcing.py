import pytest

from viewer.commands import ChangeForcing, Command, CommandError, ResetForcing, command_from_mapping


@pytest.mark.parametrize(
    ("entry", "command"),
    [
        ({"command": "ChangeForcing", "item": "a", "factor": 2}, ChangeForcing("a", factor=2.0)),
        ({"command": "ChangeForcing", "item": "a", "offset": -0.5}, ChangeForcing("a", offset=-0.5)),
        (
            {"command": "ChangeForcing", "item": "a", "series_file": "q.csv"},
            ChangeForcing("a", series_file="q.csv"),
        ),
        ({"command": "ChangeForcing", "item": "a", "start": 60}, ChangeForcing("a", start=60.0)),
        ({"command": "ChangeForcing", "item": "a", "start": "never"}, ChangeForcing("a", start="never")),
        ({"command": "ResetForcing"}, ResetForcing()),
        ({"command": "ResetForcing", "item": "a"}, ResetForcing("a")),
    ],
)
def test_a_script_can_change_the_forcing(entry: dict[str, object], command: Command) -> None:
    assert command_from_mapping(entry) == command


def test_a_change_names_its_item() -> None:
    with pytest.raises(CommandError, match="'item' is missing"):
        command_from_mapping({"command": "ChangeForcing", "factor": 2.0})
