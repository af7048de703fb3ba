import json

import pytest

from viewer.tools import Bindings, MouseTable
from viewer.tools.bindings import MOTION_KEYS
from viewer.world import Move


def test_the_tables_come_back_from_plain_values() -> None:
    keys = {{"w": "i", "s": "k"}.get(key, key): move for key, move in MOTION_KEYS.items()}
    tables = Bindings(MouseTable(left="pan", wheel="farther"), keys, {"Quit": "Ctrl+X"})

    assert Bindings.from_mapping(json.loads(json.dumps(tables.as_mapping()))) == tables


@pytest.mark.parametrize(
    "raw",
    [
        {},
        {"mouse": 5, "keys": [], "shortcuts": None},
        {"mouse": {"left": "jump", "up": "orbit"}, "keys": {"w": "fly"}, "shortcuts": {"Quit": 3}},
        {"keys": {"w": "pan_forward"}},  # the other motions would have no key
    ],
)
def test_what_is_not_valid_stays_as_it_came(raw: dict[str, object]) -> None:
    assert Bindings.from_mapping(raw) == Bindings()


def test_every_motion_of_the_camera_has_a_key() -> None:
    assert {move.upper() for move in MOTION_KEYS.values()} == set(Move.__members__)


def test_shift_changes_the_left_button_alone() -> None:
    table = MouseTable(left="orbit", shift_left="zoom", right="pan")

    assert [table.drag("left", False), table.drag("left", True)] == ["orbit", "zoom"]
    assert [table.drag("right", False), table.drag("right", True)] == ["pan", "pan"]
