import time

import msgspec

import protocol
from tests.viewer.app.conftest import Flight
from tests.viewer.tiny_service import INTERVAL
from viewer.commands import Pause, Recalculate, Seek


def test_the_picture_waits_for_the_first_frame_of_a_branch(flight: Flight) -> None:
    flight.do(Pause(), Seek(10 * INTERVAL))
    flight.settle()
    keys, control = flight.app.feed.keys, flight.app.control
    flight.service.is_streaming = False
    flight.do(Recalculate())
    flight.until(lambda: flight.shown.run == "run-2")
    for _ in range(5):
        flight.app.advance(time.monotonic())
    assert control.is_held
    assert flight.app.feed.keys == keys
    flight.service.is_streaming = True
    flight.until(lambda: not flight.app.is_busy)

    assert not control.is_held
    assert flight.app.feed.keys is not None
    assert flight.app.feed.keys[0] == ("run-2", 10)


def test_a_failed_run_says_why(flight: Flight) -> None:
    info = msgspec.structs.replace(
        flight.shown.info, status="failed", message="depth is not finite in cell (3, 4)"
    )
    flight.app.desk._handle(protocol.RunChanged(info))

    assert flight.app.message == "the run failed: depth is not finite in cell (3, 4)"
    assert flight.shown.info.status == "failed"


def test_a_second_recalculation_waits_for_the_first(flight: Flight) -> None:
    flight.do(Pause(), Seek(10 * INTERVAL))
    with flight.service.lock:
        flight.do(Recalculate())
        flight.app.dispatch(Recalculate())

    assert "under way already" in flight.app.message


def test_a_refused_recalculation_can_be_asked_for_again(flight: Flight) -> None:
    flight.do(Pause(), Seek(19 * INTERVAL))
    flight.service.computed = 5
    flight.do(Recalculate())
    flight.until(lambda: flight.app.recalculated is None)
    assert "not computed yet" in flight.app.message
    flight.service.computed = 20
    flight.do(Recalculate())

    flight.until(lambda: flight.shown.run == "run-2")
