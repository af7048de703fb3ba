import pytest

import protocol
from tests.viewer.tiny_service import GRID
from viewer.app.edit_drawing import EditDrawing, edit_text
from viewer.commands import ChangeEditSettings, CommandError


def slope(x: float, _y: float) -> float:
    return 0.1 * (x - 1000.0)


def test_a_line_needs_two_points_and_may_end_at_the_pointer() -> None:
    drawing = EditDrawing()
    drawing.begin()
    drawing.add_vertex(1100.0, 2100.0, GRID)
    assert drawing.line(slope, with_hover=True) is None
    drawing.hover = (1200.0, 2100.0)
    assert drawing.line(slope, with_hover=False) is None
    line = drawing.line(slope, with_hover=True)

    assert line is not None
    assert line.vertices == ((1100.0, 2100.0), (1200.0, 2100.0))
    assert line.reference_z is None


def test_a_straight_crest_remembers_the_ground_where_it_was_drawn() -> None:
    drawing = EditDrawing()
    drawing.begin()
    drawing.change(ChangeEditSettings(type="replace", magnitude=3.0, operation="lower", width=12.0))
    drawing.add_vertex(1100.0, 2100.0, GRID)
    drawing.add_vertex(1200.0, 2100.0, GRID)
    line = drawing.line(slope, with_hover=False)

    assert line is not None
    assert line.reference_z == pytest.approx((10.0, 20.0))
    assert (line.operation, line.type) == (protocol.Operation.lower, protocol.EditType.replace)
    assert (line.width, line.magnitude) == (12.0, 3.0)


def test_a_point_set_twice_counts_once() -> None:
    drawing = EditDrawing()
    drawing.begin()
    drawing.add_vertex(1100.0, 2100.0, GRID)
    drawing.add_vertex(1100.0, 2100.0, GRID)

    assert drawing.vertices == [(1100.0, 2100.0)]


def test_a_point_outside_the_terrain_is_refused() -> None:
    drawing = EditDrawing()
    drawing.begin()

    with pytest.raises(CommandError, match="outside the terrain"):
        drawing.add_vertex(0.0, 0.0, GRID)
    assert drawing.vertices == []


@pytest.mark.parametrize(
    "change",
    [
        ChangeEditSettings(width=0.0),
        ChangeEditSettings(magnitude=-1.0),
        ChangeEditSettings(operation="dig"),
        ChangeEditSettings(type="paint"),
    ],
)
def test_a_wrong_setting_is_refused_and_changes_nothing(change: ChangeEditSettings) -> None:
    drawing = EditDrawing()
    before = drawing.settings

    with pytest.raises(CommandError, match="not allowed"):
        drawing.change(change)
    assert drawing.settings == before


def test_every_line_gets_an_id_of_its_own() -> None:
    drawing = EditDrawing()
    drawing.begin()
    drawing.add_vertex(1100.0, 2100.0, GRID)
    drawing.add_vertex(1200.0, 2100.0, GRID)
    first, second = drawing.line(slope, with_hover=False), drawing.line(slope, with_hover=False)

    assert first is not None
    assert second is not None
    assert first.id != second.id


def test_an_edit_is_told_in_words() -> None:
    drawing = EditDrawing()
    drawing.vertices = [(1100.0, 2100.0), (1200.0, 2100.0)]
    line = drawing.line(slope, with_hover=False)

    assert line is not None
    assert edit_text(line) == "Raise by 8 m, 40 m wide, 2 points"
