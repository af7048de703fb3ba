from viewer.commands import (
    AddVertex,
    CancelEdit,
    DropVertex,
    EndStroke,
    FinishEdit,
    MoveHover,
    StrokeTo,
)
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


def test_a_drag_draws_free_hand_and_a_shaky_click_does_not() -> None:
    tool = EditTool()
    events = [
        PointerEvent("press", 0.5, 0.5, "left", ground=(1.0, 2.0)),
        PointerEvent("move", 0.502, 0.501, "left", ground=(1.1, 2.0)),
        PointerEvent("release", 0.502, 0.501, "left", ground=(1.1, 2.0)),
        PointerEvent("press", 0.5, 0.5, "left", ground=(1.0, 2.0)),
        PointerEvent("move", 0.55, 0.5, "left", ground=(5.0, 2.0)),
        PointerEvent("move", 0.60, 0.0, "left"),
        PointerEvent("release", 0.62, 0.5, "left", ground=(9.0, 2.0)),
        PointerEvent("release", 0.62, 0.5, "left", ground=(9.0, 2.0)),
    ]
    commands = [command for event in events for command in tool.handle(event)]
    assert commands == [
        AddVertex(1.0, 2.0),
        AddVertex(1.0, 2.0),
        StrokeTo(5.0, 2.0),
        StrokeTo(9.0, 2.0),
        EndStroke(),
    ]


def test_a_stroke_that_ends_in_the_sky_ends_where_it_left_the_ground() -> None:
    tool = EditTool()
    tool.handle(PointerEvent("press", 0.5, 0.5, "left", ground=(1.0, 2.0)))
    tool.handle(PointerEvent("move", 0.55, 0.5, "left", ground=(5.0, 2.0)))
    assert tool.handle(PointerEvent("release", 0.6, 0.0, "left")) == [EndStroke()]


def test_backspace_takes_the_last_point_off() -> None:
    assert EditTool().handle_key("backspace") == [DropVertex()]
