from viewer.commands import CancelEdit, DragEdit, DropEdit, GrabEdit, MoveHover, SelectEdit
from viewer.tools import PointerEvent, SelectTool

PRESS = PointerEvent("press", 0.5, 0.5, "left", ground=(1.0, 2.0))


def test_a_click_selects_and_moves_nothing() -> None:
    tool = SelectTool()
    assert tool.handle(PRESS) == [GrabEdit(1.0, 2.0)]
    assert tool.handle(PointerEvent("move", 0.501, 0.5, "left", ground=(1.1, 2.0))) == []
    assert tool.handle(PointerEvent("release", 0.501, 0.5, "left", ground=(1.1, 2.0))) == [DropEdit()]


def test_a_drag_moves_and_ends_where_the_button_goes_up() -> None:
    tool = SelectTool()
    tool.handle(PRESS)
    assert tool.handle(PointerEvent("move", 0.6, 0.5, "left", ground=(5.0, 2.0))) == [DragEdit(5.0, 2.0)]
    assert tool.handle(PointerEvent("move", 0.6, 0.0, "left")) == []
    end = PointerEvent("release", 0.7, 0.5, "left", ground=(9.0, 2.0))
    assert tool.handle(end) == [DragEdit(9.0, 2.0), DropEdit()]


def test_a_click_into_the_sky_selects_nothing() -> None:
    assert SelectTool().handle(PointerEvent("press", 0.5, 0.0, "left")) == [SelectEdit(None)]


def test_the_pointer_is_followed_and_escape_puts_the_tool_away() -> None:
    tool = SelectTool()
    assert tool.handle(PointerEvent("move", 0.5, 0.5, ground=(1.0, 2.0))) == [MoveHover(1.0, 2.0)]
    assert tool.handle(PointerEvent("move", 0.5, 0.0)) == [MoveHover(None, None)]
    assert tool.handle_key("escape") == [CancelEdit()]
    assert tool.handle_key("enter") == []
