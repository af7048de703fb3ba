from viewer.commands import AddVertex, CancelEdit, GrabView, HoldMove, ReleaseMoves, Zoom
from viewer.tools import PointerEvent, Toolbox

PRESS = PointerEvent("press", 0.5, 0.5, "left", ground=(1.0, 2.0))


def test_a_press_goes_to_the_camera_or_to_the_edit_line() -> None:
    assert Toolbox().pointer(PRESS, is_drawing=False) == [GrabView(True)]
    assert Toolbox().pointer(PRESS, is_drawing=True) == [AddVertex(1.0, 2.0)]


def test_the_wheel_zooms_even_while_drawing() -> None:
    assert Toolbox().pointer(PointerEvent("wheel", 0.5, 0.5, steps=1.0), is_drawing=True) == [Zoom(1.0)]


def test_escape_means_something_only_while_drawing() -> None:
    assert Toolbox().key_pressed("escape", is_drawing=True) == [CancelEdit()]
    assert Toolbox().key_pressed("escape", is_drawing=False) == []


def test_motion_keys_work_while_drawing() -> None:
    assert Toolbox().key_pressed("a", is_drawing=True) == [HoldMove("pan_left", True)]
    assert Toolbox().key_released("a") == [HoldMove("pan_left", False)]


def test_without_the_keyboard_nothing_is_held() -> None:
    assert Toolbox().keyboard_lost() == [ReleaseMoves()]
