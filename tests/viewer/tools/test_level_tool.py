from viewer.commands import CancelEdit, MoveHover, TakeLevel
from viewer.tools import LevelTool, PointerEvent


def test_a_click_takes_the_level_there_and_one_into_the_sky_does_not() -> None:
    tool = LevelTool()
    assert tool.handle(PointerEvent("press", 0.5, 0.5, "left", ground=(1.0, 2.0))) == [TakeLevel(1.0, 2.0)]
    assert tool.handle(PointerEvent("press", 0.5, 0.0, "left")) == []
    assert tool.handle(PointerEvent("release", 0.5, 0.5, "left", ground=(1.0, 2.0))) == []


def test_the_pointer_is_followed_and_escape_takes_no_level() -> None:
    tool = LevelTool()
    assert tool.handle(PointerEvent("move", 0.5, 0.5, ground=(1.0, 2.0))) == [MoveHover(1.0, 2.0)]
    assert tool.handle_key("escape") == [CancelEdit()]
    assert tool.handle_key("enter") == []
