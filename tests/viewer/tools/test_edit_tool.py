from viewer.commands import AddVertex, CancelEdit, FinishEdit, MoveHover
from viewer.tools import EditTool, PointerEvent


def test_a_click_sets_a_point() -> None:
    assert EditTool().handle(PointerEvent("press", 0.5, 0.5, "left", ground=(1.0, 2.0))) == [
        AddVertex(1.0, 2.0)
    ]


def test_a_double_click_finishes_without_setting_its_point_twice() -> None:
    tool = EditTool()
    kinds = ("press", "release", "double", "release")
    commands = [
        command
        for kind in kinds
        for command in tool.handle(PointerEvent(kind, 0.5, 0.5, "left", ground=(1.0, 2.0)))  # type: ignore[arg-type]
    ]

    assert commands == [AddVertex(1.0, 2.0), FinishEdit()]


def test_the_rubber_band_follows_the_pointer_and_ends_over_the_sky() -> None:
    tool = EditTool()

    assert tool.handle(PointerEvent("move", 0.5, 0.5, ground=(1.0, 2.0))) == [MoveHover(1.0, 2.0)]
    assert tool.handle(PointerEvent("move", 0.5, 0.0)) == [MoveHover(None, None)]


def test_a_click_into_the_sky_sets_nothing() -> None:
    assert EditTool().handle(PointerEvent("press", 0.5, 0.0, "left")) == []


def test_enter_finishes_and_escape_drops() -> None:
    tool = EditTool()

    assert tool.handle_key("enter") == [FinishEdit()]
    assert tool.handle_key("escape") == [CancelEdit()]
    assert tool.handle_key("w") == []


def test_right_drags_and_the_wheel_stay_with_the_camera() -> None:
    tool = EditTool()

    assert tool.wants(PointerEvent("press", 0.5, 0.5, "left"))
    assert tool.wants(PointerEvent("move", 0.5, 0.5))
    assert not tool.wants(PointerEvent("move", 0.5, 0.5, "right"))
    assert not tool.wants(PointerEvent("wheel", 0.5, 0.5, steps=1.0))
