from viewer.commands import (
    AddMeasurePoint,
    AddVertex,
    CancelEdit,
    EndMeasure,
    GrabEdit,
    GrabView,
    HoldMove,
    MoveHover,
    ReleaseMoves,
    TakeLevel,
    Zoom,
)
from viewer.tools import Bindings, MouseTable, PointerEvent, Toolbox

PRESS = PointerEvent("press", 0.5, 0.5, "left", ground=(1.0, 2.0))


def test_a_press_goes_to_the_camera_or_to_the_edit_line() -> None:
    assert Toolbox().pointer(PRESS, tool="") == [GrabView(True)]
    assert Toolbox().pointer(PRESS, tool="line") == [AddVertex(1.0, 2.0)]


def test_each_tool_gets_its_events_and_other_buttons_stay_with_the_camera() -> None:
    box = Toolbox()
    assert box.pointer(PRESS, tool="area") == [AddVertex(1.0, 2.0)]
    assert box.pointer(PRESS, tool="select") == [GrabEdit(1.0, 2.0)]
    assert box.pointer(PRESS, tool="level") == [TakeLevel(1.0, 2.0)]
    for tool in ("line", "area", "select", "level"):
        right = PointerEvent("press", 0.5, 0.5, "right", ground=(1.0, 2.0))
        assert box.pointer(right, tool=tool) == [GrabView(True)]
        assert box.pointer(PointerEvent("release", 0.5, 0.5, "right"), tool=tool) == [GrabView(False)]
        hover = PointerEvent("move", 0.5, 0.5, ground=(3.0, 4.0))
        assert box.pointer(hover, tool=tool) == [MoveHover(3.0, 4.0)]


def test_the_wheel_zooms_even_while_drawing() -> None:
    assert Toolbox().pointer(PointerEvent("wheel", 0.5, 0.5, steps=1.0), tool="line") == [Zoom(1.0)]


def test_escape_means_something_only_while_drawing() -> None:
    assert Toolbox().key_pressed("escape", tool="line") == [CancelEdit()]
    assert Toolbox().key_pressed("escape", tool="") == []


def test_motion_keys_work_while_drawing() -> None:
    assert Toolbox().key_pressed("a", tool="line") == [HoldMove("pan_left", True)]
    assert Toolbox().key_released("a") == [HoldMove("pan_left", False)]


def test_without_the_keyboard_nothing_is_held() -> None:
    assert Toolbox().keyboard_lost() == [ReleaseMoves()]


def test_the_measuring_tool_is_one_of_them() -> None:
    assert Toolbox().pointer(PRESS, tool="measure") == [AddMeasurePoint(1.0, 2.0)]
    assert Toolbox().key_pressed("escape", tool="measure") == [EndMeasure()]


def test_the_tables_can_be_changed() -> None:
    box = Toolbox()
    box.bind(Bindings(MouseTable(wheel="farther"), {"k": "zoom_in"}))

    assert box.key_pressed("k") == [HoldMove("zoom_in", True)]
    assert box.key_pressed("w") == []
    assert box.pointer(PointerEvent("wheel", 0.5, 0.5, steps=1.0)) == [Zoom(-1.0)]
