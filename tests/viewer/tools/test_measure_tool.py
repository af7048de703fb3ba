from viewer.commands import AddMeasurePoint, EndMeasure, MoveHover
from viewer.tools import MeasureTool, PointerEvent

GROUND = (10.0, 20.0)


def test_a_click_sets_a_point_and_moving_leads_the_rubber_band() -> None:
    tool = MeasureTool()

    assert tool.handle(PointerEvent("press", 0.5, 0.5, "left", ground=GROUND)) == [AddMeasurePoint(*GROUND)]
    assert tool.handle(PointerEvent("move", 0.5, 0.5, ground=GROUND)) == [MoveHover(*GROUND)]
    assert tool.handle(PointerEvent("move", 0.5, 0.5)) == [MoveHover(None, None)]
    assert tool.handle(PointerEvent("press", 0.5, 0.5, "left")) == []
    assert tool.handle(PointerEvent("release", 0.5, 0.5, "left", ground=GROUND)) == []


def test_escape_puts_the_tool_away() -> None:
    assert MeasureTool().handle_key("escape") == [EndMeasure()]
    assert MeasureTool().handle_key("enter") == []
