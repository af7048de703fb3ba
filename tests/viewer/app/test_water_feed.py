import numpy as np

from tests.viewer.app.conftest import Flight
from tests.viewer.tiny_service import INTERVAL, valley
from viewer.commands import AddVertex, BeginEdit, FinishEdit, Pause, Recalculate, Seek


def test_equal_frames_keep_their_name_so_that_they_are_uploaded_once(flight: Flight) -> None:
    flight.do(Pause(), Seek(7.2 * INTERVAL))
    flight.settle()
    first = flight.app.feed.pair
    flight.do(Seek(7.6 * INTERVAL))
    flight.settle()
    second = flight.app.feed.pair

    assert first is not None
    assert second is not None
    assert (first.first.key, first.second.key) == (second.first.key, second.second.key)
    assert first.first.h is second.first.h
    assert second.alpha > first.alpha


def test_nothing_changes_while_the_time_stands(flight: Flight) -> None:
    flight.do(Pause(), Seek(7.2 * INTERVAL))
    flight.settle()

    assert not flight.app.feed.advance(flight.shown, flight.app.clock.time)


def test_the_water_lies_on_the_bed_it_was_computed_with(flight: Flight) -> None:
    flight.do(Pause(), Seek(10 * INTERVAL), BeginEdit(), AddVertex(1400.0, 2200.0), AddVertex(1400.0, 2500.0))
    flight.do(FinishEdit(), Recalculate())
    flight.until(lambda: flight.shown.run == "run-2" and not flight.app.is_busy)
    branch = flight.app.feed.pair
    flight.do(Seek(5 * INTERVAL))
    flight.settle()
    past = flight.app.feed.pair

    assert branch is not None
    assert past is not None
    assert branch.first.z_b is not None
    assert past.first.z_b is not None
    assert (branch.first.z_b != valley()).any()
    np.testing.assert_array_equal(past.first.z_b, valley())


def test_a_frame_that_is_not_at_hand_is_fetched(flight: Flight) -> None:
    flight.do(Pause())
    shown = flight.shown
    flight.app.loader._packed["run-1"].drop_from(3)
    for index in range(3, 20):
        shown.timeline.discard(index)
    assert shown.timeline.last_time == 2 * INTERVAL
    flight.do(Seek(15 * INTERVAL))
    flight.until(lambda: 15 in shown.timeline)
    flight.settle()

    assert flight.app.feed.keys is not None
    assert flight.app.feed.keys[0] == ("run-1", 15)
