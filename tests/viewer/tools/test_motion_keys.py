from viewer.commands import HoldMove
from viewer.tools import MotionKeys
from viewer.tools.bindings import MOTION_KEYS
from viewer.world import Move


def test_a_key_begins_a_move_and_ends_it() -> None:
    keys = MotionKeys()

    assert keys.press("w") == [HoldMove("pan_forward", True)]
    assert keys.release("w") == [HoldMove("pan_forward", False)]


def test_other_keys_move_nothing() -> None:
    assert MotionKeys().press("x") == []


def test_every_key_names_a_move_that_the_camera_knows() -> None:
    assert {name.upper() for name in MOTION_KEYS.values()} == set(Move.__members__)


def test_the_table_can_be_another_one() -> None:
    assert MotionKeys({"k": "zoom_in"}).press("k") == [HoldMove("zoom_in", True)]
