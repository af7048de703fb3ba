import dataclasses
import math

import pytest

import protocol
from tests.viewer.tiny_service import GRID
from viewer.app.edit_drawing import EditDrawing, changed_settings
from viewer.commands import ChangeEditSettings, CommandError
from viewer.view_status import EditSettings


def slope(x: float, _y: float) -> float:
    return 0.1 * (x - 1000.0)


def test_a_line_needs_two_points_and_may_end_at_the_pointer() -> None:
    drawing = EditDrawing()
    drawing.begin()
    drawing.add_vertex(1100.0, 2100.0, GRID)
    assert drawing.edit(slope, with_hover=True) is None
    drawing.hover = (1200.0, 2100.0)
    assert drawing.edit(slope, with_hover=False) is None
    line = drawing.edit(slope, with_hover=True)

    assert line is not None
    assert line.vertices == ((1100.0, 2100.0), (1200.0, 2100.0))
    assert line.reference_z is None


def test_a_straight_crest_remembers_the_ground_where_it_was_drawn() -> None:
    drawing = EditDrawing()
    drawing.begin()
    change = ChangeEditSettings(type="replace", magnitude=3.0, operation="lower", width=12.0)
    drawing.settings = changed_settings(drawing.settings, change)
    drawing.add_vertex(1100.0, 2100.0, GRID)
    drawing.add_vertex(1200.0, 2100.0, GRID)
    line = drawing.edit(slope, with_hover=False)

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
        ChangeEditSettings(width=math.inf),
        ChangeEditSettings(level=30_000.0),
        ChangeEditSettings(level=math.nan),
        ChangeEditSettings(operation="dig"),
        ChangeEditSettings(type="paint"),
    ],
)
def test_a_wrong_setting_is_refused(change: ChangeEditSettings) -> None:
    with pytest.raises(CommandError, match="not allowed"):
        changed_settings(EditSettings(), change)


def test_every_line_gets_an_id_of_its_own() -> None:
    drawing = EditDrawing()
    drawing.begin()
    drawing.add_vertex(1100.0, 2100.0, GRID)
    drawing.add_vertex(1200.0, 2100.0, GRID)
    first, second = drawing.edit(slope, with_hover=False), drawing.edit(slope, with_hover=False)

    assert first is not None
    assert second is not None
    assert first.id != second.id


def test_only_the_settings_named_change() -> None:
    before = EditSettings(width=7.0)
    assert changed_settings(before, ChangeEditSettings()) == before
    after = changed_settings(before, ChangeEditSettings(level=310.5, at_level=True))
    assert after == dataclasses.replace(before, level=310.5, at_level=True)


def test_an_area_needs_three_points_and_is_closed_on_its_first() -> None:
    drawing = EditDrawing()
    drawing.begin("area")
    for point in ((1100.0, 2100.0), (1200.0, 2100.0)):
        drawing.add_vertex(*point, GRID)
    assert drawing.edit(slope, with_hover=False) is None
    assert not drawing.closes(1100.0, 2100.0, 5.0)
    drawing.add_vertex(1200.0, 2200.0, GRID)

    assert drawing.closes(1103.0, 2104.0, 5.0)
    assert not drawing.closes(1103.0, 2104.1, 5.0)
    area = drawing.edit(slope, with_hover=False)
    assert isinstance(area, protocol.EditArea)
    assert area.vertices == ((1100.0, 2100.0), (1200.0, 2100.0), (1200.0, 2200.0))


def test_an_edit_of_another_kind_is_refused() -> None:
    with pytest.raises(CommandError, match="circle"):
        EditDrawing().begin("circle")


def test_a_crest_at_a_level_needs_no_ground() -> None:
    drawing = EditDrawing()
    drawing.begin()
    drawing.settings = EditSettings(type="replace", level=57.5, at_level=True)
    drawing.vertices = [(1100.0, 2100.0), (1200.0, 2100.0)]
    line = drawing.edit(slope, with_hover=False)

    assert line is not None
    assert (line.level, line.reference_z) == (57.5, None)
    drawing.settings = dataclasses.replace(drawing.settings, type="modulate")
    line = drawing.edit(slope, with_hover=False)
    assert line is not None
    assert (line.level, line.reference_z) == (None, None)


def test_a_stroke_is_thinned_out_to_its_shape_and_points_set_before_it_stay() -> None:
    drawing = EditDrawing()
    drawing.begin()
    for point in ((1100.0, 2100.0), (1150.0, 2101.0), (1200.0, 2100.0)):
        drawing.add_vertex(*point, GRID)
    for step in range(1, 101):
        drawing.stroke_to(1200.0, 2100.0 + 4.0 * step, GRID)
    for step in range(1, 51):
        drawing.stroke_to(1200.0 + 4.0 * step, 2500.0 + (step % 2), GRID)
    assert len(drawing.vertices) == 153
    drawing.end_stroke(GRID)

    assert drawing.vertices == [
        (1100.0, 2100.0),
        (1150.0, 2101.0),
        (1200.0, 2100.0),
        (1200.0, 2500.0),
        (1400.0, 2500.0),
    ]
    drawing.end_stroke(GRID)
    assert len(drawing.vertices) == 5


def test_the_last_point_can_be_taken_off_again() -> None:
    drawing = EditDrawing()
    drawing.begin()
    drawing.drop_vertex()
    drawing.add_vertex(1100.0, 2100.0, GRID)
    drawing.drop_vertex()
    assert drawing.vertices == []


def test_an_edit_has_a_limited_number_of_points() -> None:
    drawing = EditDrawing()
    drawing.begin()
    drawing.vertices = [(1100.0 + n % 2, 2100.0) for n in range(protocol.limits.MAX_VERTICES)]
    with pytest.raises(CommandError, match=str(protocol.limits.MAX_VERTICES)):
        drawing.add_vertex(1150.0, 2100.0, GRID)
