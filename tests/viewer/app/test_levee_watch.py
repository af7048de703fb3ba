"""Levees across the tongue of water of the tiny service, high and low."""

from tests.viewer.app.conftest import Flight
from tests.viewer.tiny_service import FRAMES, INTERVAL
from viewer.commands import (
    AddVertex,
    BeginEdit,
    ChangeEdit,
    ChangeEditSettings,
    FinishEdit,
    Pause,
    Recalculate,
    RenameEdit,
    Seek,
)


def levee_of(flight: Flight, magnitude: float) -> None:
    """A levee across the valley floor, computed to the end and looked at."""
    flight.do(Pause(), Seek(10 * INTERVAL), ChangeEditSettings(magnitude=magnitude), BeginEdit())
    flight.do(AddVertex(1200.0, 2200.0), AddVertex(1200.0, 2520.0), FinishEdit(), Recalculate())
    parent = flight.shown.run
    flight.until(lambda: flight.shown.run != parent and not flight.app.is_busy)
    flight.service.computed = FRAMES
    flight.have_frames(FRAMES)
    for index in (9, 12, 15, 20, 30):
        flight.do(Seek(index * INTERVAL))
        flight.settle()


def test_a_high_levee_is_not_reported(flight: Flight) -> None:
    levee_of(flight, 8.0)
    (row,) = flight.app.fresh_status().edits

    assert row.warning == ""
    assert row.measure.startswith("320 m long, ")


def test_a_low_levee_is_reported_with_time_and_place(flight: Flight) -> None:
    levee_of(flight, 1.0)
    (row,) = flight.app.fresh_status().edits
    (edit,) = flight.shown.document.edits
    found = flight.app._levee_watch.overtopping(flight.shown, edit)

    assert found is not None
    assert found.time == 10 * INTERVAL
    assert abs(found.x - 1200.0) <= 25.0
    assert 2295.0 <= found.y <= 2430.0
    assert row.warning.startswith("overtopped at 00:0")


def test_the_past_before_the_levee_does_not_count(flight: Flight) -> None:
    flight.do(Pause(), Seek(19 * INTERVAL))
    flight.settle()
    flight.do(ChangeEditSettings(magnitude=1.0), BeginEdit(), AddVertex(1200.0, 2200.0))
    flight.do(AddVertex(1200.0, 2520.0), FinishEdit())
    flight.until(lambda: not flight.app.is_busy)
    flight.do(Seek(18 * INTERVAL))
    flight.settle()
    (row,) = flight.app.fresh_status().edits

    assert not row.is_applied
    assert row.warning == ""


def test_what_was_seen_before_a_levee_was_raised_does_not_count_but_its_name_does_not_matter(
    flight: Flight,
) -> None:
    levee_of(flight, 1.0)
    flight.do(RenameEdit("Low", flight.shown.document.edits[0].id))
    flight.until(lambda: not flight.app.is_busy)
    (row,) = flight.app.fresh_status().edits
    assert row.warning.startswith("overtopped")
    assert row.is_applied
    flight.do(ChangeEdit(magnitude=9.0, edit=row.id))
    flight.until(lambda: not flight.app.is_busy)
    (row,) = flight.app.fresh_status().edits

    assert row.warning == ""
    assert not row.is_applied
