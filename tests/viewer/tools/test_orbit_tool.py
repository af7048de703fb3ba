import pytest

from viewer.commands import DragOrbit, DragPan, GrabView, MoveHover, ProbeAt, Zoom
from viewer.tools import MouseTable, OrbitTool, PointerEvent


def drag(button: str, shift: bool = False) -> list[object]:
    tool = OrbitTool()
    events = [
        PointerEvent("press", 0.5, 0.5, button, shift),  # type: ignore[arg-type]
        PointerEvent("move", 0.6, 0.45, button, shift),  # type: ignore[arg-type]
        PointerEvent("release", 0.6, 0.45, button, shift, ground=(3.0, 4.0)),  # type: ignore[arg-type]
    ]
    return [command for event in events for command in tool.handle(event)]


def test_a_left_drag_turns_the_camera() -> None:
    begin, turn, end = drag("left")

    assert begin == GrabView(True)
    assert isinstance(turn, DragOrbit)
    assert (turn.dx, turn.dy) == pytest.approx((0.1, -0.05))
    assert end == GrabView(False)


@pytest.mark.parametrize(("button", "shift"), [("right", False), ("middle", False), ("left", True)])
def test_other_drags_move_the_ground(button: str, shift: bool) -> None:
    assert isinstance(drag(button, shift)[1], DragPan)


def test_the_wheel_comes_nearer_to_what_is_under_the_pointer() -> None:
    over_ground = PointerEvent("wheel", 0.5, 0.5, steps=2.0, ground=(3.0, 4.0))

    assert OrbitTool().handle(over_ground) == [Zoom(2.0, 3.0, 4.0)]
    assert OrbitTool().handle(PointerEvent("wheel", 0.5, 0.1, steps=2.0)) == [Zoom(2.0)]


def test_a_click_without_a_drag_probes_the_ground() -> None:
    tool = OrbitTool()
    tool.handle(PointerEvent("press", 0.5, 0.5, "left", ground=(3.0, 4.0)))

    assert tool.handle(PointerEvent("release", 0.501, 0.5, "left", ground=(3.0, 4.0))) == [
        GrabView(False),
        ProbeAt(3.0, 4.0),
    ]


def test_a_click_into_the_sky_probes_nothing() -> None:
    tool = OrbitTool()
    tool.handle(PointerEvent("press", 0.5, 0.5, "left"))

    assert tool.handle(PointerEvent("release", 0.5, 0.5, "left")) == [GrabView(False)]


def test_a_bare_move_reads_out_what_is_under_the_pointer() -> None:
    tool = OrbitTool()

    assert tool.handle(PointerEvent("move", 0.5, 0.5, ground=(3.0, 4.0))) == [MoveHover(3.0, 4.0)]
    assert tool.handle(PointerEvent("move", 0.5, 0.1)) == [MoveHover(None, None)]
    assert tool.handle(PointerEvent("leave", 0.0, 0.0)) == [MoveHover(None, None)]


def test_the_table_says_what_drags_the_wheel_and_two_fingers_do() -> None:
    tool = OrbitTool(MouseTable(left="pan", right="zoom", wheel="farther", scroll="orbit"))
    tool.handle(PointerEvent("press", 0.5, 0.5, "left"))
    (panned,) = tool.handle(PointerEvent("move", 0.6, 0.5, "left"))
    tool.handle(PointerEvent("release", 0.6, 0.5, "left"))
    tool.handle(PointerEvent("press", 0.5, 0.5, "right"))
    (zoomed,) = tool.handle(PointerEvent("move", 0.5, 0.25, "right"))

    assert isinstance(panned, DragPan)
    assert zoomed == Zoom(3.0)
    assert tool.handle(PointerEvent("wheel", 0.5, 0.5, steps=1.0)) == [Zoom(-1.0)]
    assert tool.handle(PointerEvent("scroll", 0.0, 0.0, dx=0.1, dy=0.2)) == [DragOrbit(0.1, 0.2)]
