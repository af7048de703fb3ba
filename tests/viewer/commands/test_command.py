import dataclasses

import pytest

from viewer import commands

EVERY_COMMAND = commands.Command.__args__


@pytest.mark.parametrize("kind", EVERY_COMMAND)
def test_every_command_is_frozen_and_listed(kind: type) -> None:
    assert dataclasses.is_dataclass(kind)
    assert kind.__dataclass_params__.frozen  # type: ignore[attr-defined]
    assert kind.__name__ in commands.__all__


def test_every_listed_command_can_be_carried_out() -> None:
    listed = {name for name in commands.__all__ if name[0].isupper()} - {"Command", "CommandError"}

    assert listed == {kind.__name__ for kind in EVERY_COMMAND}
