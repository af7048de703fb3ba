import time

import msgspec
import numpy as np
import pytest

import protocol
from tests.viewer.app.conftest import Flight
from tests.viewer.tiny_service import INTERVAL
from viewer.commands import (
    AddVertex,
    BeginEdit,
    BeginLevelPick,
    BeginSelect,
    CancelEdit,
    ChangeEditSettings,
    Command,
    CommandError,
    DragEdit,
    DropEdit,
    FinishEdit,
    GrabEdit,
    Pause,
    Seek,
    SelectEdit,
    SetSpeed,
    StrokeTo,
    TakeLevel,
    Undo,
)


def test_other_commands_are_left_to_others(flight: Flight) -> None:
    assert not flight.app.control.editing.carry_out(SetSpeed(2.0), flight.shown)


def test_without_a_run_there_is_nothing_to_edit(flight: Flight) -> None:
    with pytest.raises(CommandError, match="no run is shown"):
        flight.app.control.editing.carry_out(BeginEdit(), None)


def test_a_dropped_line_leaves_the_ground_as_it_was(flight: Flight) -> None:
    base = flight.shown.document.base
    flight.do(Pause(), BeginEdit(), AddVertex(1400.0, 2200.0), AddVertex(1400.0, 2500.0))
    flight.until(lambda: bool((flight.shown.heightfield.z_b != base).any()))
    flight.do(CancelEdit())

    flight.until(lambda: bool((flight.shown.heightfield.z_b == base).all()))
    assert not flight.app.control.editing.drawing.is_on


def levee(flight: Flight, x: float = 1400.0) -> protocol.Edit:
    """A line that the working list has."""
    flight.do(Pause(), BeginEdit(), AddVertex(x, 2200.0), AddVertex(x, 2500.0), FinishEdit())
    flight.until(lambda: not flight.app.is_busy)
    return flight.shown.document.edits[-1]


def taken(flight: Flight, *commands: Command) -> tuple[protocol.Edit, ...]:
    """The working list after commands."""
    flight.do(*commands)
    flight.until(lambda: not flight.app.is_busy)
    return flight.shown.document.edits


def test_a_finished_line_stays_on_the_ground_until_the_service_has_it(flight: Flight) -> None:
    changes = flight.app.control.editing.list
    with flight.service.lock:  # the service answers nothing now
        flight.do(Pause(), BeginEdit(), AddVertex(1400.0, 2200.0), AddVertex(1400.0, 2500.0), FinishEdit())
        assert changes.unconfirmed is not None
        assert flight.shown.document.draft is changes.unconfirmed
    flight.until(lambda: changes.unconfirmed is None)

    assert flight.shown.document.draft is None
    assert len(flight.shown.document.edits) == 1


def test_a_line_the_service_refuses_is_taken_off_again(flight: Flight) -> None:
    service_run = flight.service.runs[flight.shown.run]
    for number in range(protocol.limits.MAX_EDITS):
        service_run.log.append(
            protocol.EditLine(
                id=f"e{number}",
                vertices=((1100.0, 2100.0), (1110.0, 2100.0)),
                width=10.0,
                operation=protocol.Operation.raise_,
                type=protocol.EditType.modulate,
                magnitude=1.0,
            )
        )
    flight.do(Pause(), BeginEdit(), AddVertex(1400.0, 2200.0), AddVertex(1400.0, 2500.0), FinishEdit())
    flight.until(lambda: "add the edit" in flight.app.message)

    assert flight.app.control.editing.list.unconfirmed is None
    assert flight.shown.document.draft is None


def test_an_area_is_drawn_and_closed_by_a_click_on_its_first_corner(flight: Flight) -> None:
    corners = ((1200.0, 2200.0), (1400.0, 2200.0), (1400.0, 2400.0), (1200.0, 2400.0))
    flight.do(Pause(), ChangeEditSettings(operation="lower", magnitude=2.0), BeginEdit("area"))
    assert flight.app.fresh_status().edit_tool == "area"
    (area,) = taken(flight, *(AddVertex(*corner) for corner in corners), AddVertex(1201.0, 2201.0))

    assert isinstance(area, protocol.EditArea)
    assert area.vertices == corners
    expected = protocol.apply_edits(flight.shown.document.base, [area], flight.shown.grid).z_b
    flight.until(lambda: np.array_equal(flight.shown.heightfield.z_b, expected))
    assert flight.app.fresh_status().edit_tool == ""


def test_a_free_hand_line_is_thinned_out_when_it_is_finished(flight: Flight) -> None:
    flight.do(Pause(), BeginEdit(), AddVertex(1200.0, 2200.0))
    strokes = [StrokeTo(1200.0 + 4.0 * step, 2200.0 + step % 2) for step in range(1, 51)]
    (line,) = taken(flight, *strokes, FinishEdit())
    assert line.vertices == ((1200.0, 2200.0), (1400.0, 2200.0))


def test_an_edit_is_selected_moved_by_the_pointer_and_let_go(flight: Flight) -> None:
    made, other = levee(flight), levee(flight, 1600.0)
    flight.do(BeginSelect(), GrabEdit(1400.0, 2350.0), DragEdit(1450.0, 2350.0))
    status = flight.app.fresh_status()
    assert (status.edit_tool, status.selected_edit) == ("select", made.id)
    there = msgspec.structs.replace(made, vertices=((1450.0, 2200.0), (1450.0, 2500.0)))
    expected = protocol.apply_edits(flight.shown.document.base, [there, other], flight.shown.grid).z_b
    flight.until(lambda: np.array_equal(flight.shown.heightfield.z_b, expected))
    assert taken(flight, DropEdit()) == (there, other)
    assert flight.app.fresh_status().selected_edit == made.id


def test_a_move_that_is_cancelled_leaves_the_edit_where_it_was(flight: Flight) -> None:
    made = levee(flight)
    before = flight.shown.document.bed_of([made])
    flight.do(BeginSelect(), GrabEdit(1400.0, 2350.0), DragEdit(1450.0, 2350.0), CancelEdit())
    flight.until(lambda: np.array_equal(flight.shown.heightfield.z_b, before))

    assert flight.shown.document.edits == (made,)
    assert flight.app.fresh_status().edit_tool == ""


def test_a_selection_ends_with_its_edit(flight: Flight) -> None:
    made = levee(flight)
    flight.do(SelectEdit(made.id))
    with pytest.raises(protocol.EditError, match="'nobody' is not in the list"):
        flight.do(SelectEdit("nobody"))
    assert flight.app.fresh_status().selected_edit == made.id
    taken(flight, Undo())
    status = flight.app.fresh_status()
    assert (status.selected_edit, [row.id for row in status.undone_edits]) == (None, [made.id])


def test_the_level_of_a_crest_is_taken_from_the_ground_or_the_water(flight: Flight) -> None:
    flight.do(Pause(), Seek(10 * INTERVAL), BeginLevelPick())
    flight.settle()
    assert flight.app.fresh_status().edit_tool == "level"
    dry = flight.app.pointing.readout(1805.0, 2105.0, flight.shown)
    wet = flight.app.pointing.readout(1105.0, 2355.0, flight.shown)
    assert dry is not None
    assert wet is not None
    assert (dry.level, wet.depth > 0.1) == (None, True)
    flight.do(TakeLevel(1805.0, 2105.0))
    settings = flight.app.fresh_status().edit_settings
    assert (settings.type, settings.at_level, settings.level) == ("replace", True, round(dry.ground, 2))
    assert "from the ground" in flight.app.message
    flight.do(TakeLevel(1105.0, 2355.0))
    assert wet.level is not None
    assert flight.app.fresh_status().edit_settings.level == round(wet.level, 2)
    assert "from the water" in flight.app.message
    with pytest.raises(CommandError, match="outside the terrain"):
        flight.do(TakeLevel(0.0, 0.0))


def test_the_level_goes_to_the_selected_edit(flight: Flight) -> None:
    made = levee(flight)
    (changed,) = taken(flight, SelectEdit(made.id), TakeLevel(1805.0, 2105.0))
    ground = flight.app.pointing.readout(1805.0, 2105.0, flight.shown)
    assert ground is not None
    assert (changed.id, changed.type, changed.level) == (made.id, "replace", round(ground.ground, 2))


def test_an_edit_that_is_too_much_work_is_told_and_not_previewed(flight: Flight) -> None:
    flight.do(Pause(), ChangeEditSettings(width=1e5), BeginEdit())
    drawing = flight.app.control.editing.drawing
    drawing.vertices = [(1000.0 + 4.0 * n, 2000.0 if n % 2 else 2600.0) for n in range(200)] * 5
    flight.do(AddVertex(1805.0, 2105.0))

    assert "cells looked at" in flight.app.message
    assert flight.app.advance(time.monotonic())
    with pytest.raises(protocol.EditError, match="cells looked at"):
        flight.do(FinishEdit())
    flight.do(CancelEdit())
    assert flight.shown.document.draft is None
