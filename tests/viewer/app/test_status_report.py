from tests.viewer.app.conftest import Flight
from tests.viewer.tiny_service import INTERVAL, TinyService
from viewer.app.levee_watch import LeveeWatch
from viewer.app.status_report import point_readout, program_status, run_status
from viewer.commands import Pause, Seek


def test_the_program_part_needs_no_run() -> None:
    flight = Flight(TinyService(), start=False)
    flight.until(lambda: flight.app.desk.is_open and bool(flight.app.desk.book.cases))
    app = flight.app
    status = program_status(app.desk, app.clock, app.control.editing, "hello")

    assert (status.is_connected, status.message, status.shown_run) == (True, "hello", None)
    assert [row.name for row in status.cases] == ["tiny"]
    flight.close()


def test_the_run_part_says_what_can_be_done_now(flight: Flight) -> None:
    app = flight.app
    status = program_status(app.desk, app.clock, app.control.editing, "")
    made = run_status(status, flight.shown, app.desk, None, LeveeWatch(), app.control.forcing)

    assert (made.can_recalculate, made.can_undo, made.is_recalculating) == (True, False, False)
    assert (made.computed_until, made.duration) == (19 * INTERVAL, 39 * INTERVAL)


def test_a_point_is_read_between_two_frames_as_the_picture_is(flight: Flight) -> None:
    flight.do(Pause(), Seek(10.5 * INTERVAL))
    flight.settle()
    read = point_readout(flight.shown, flight.app.feed, (1285.0, 2365.0))
    edge = point_readout(flight.shown, flight.app.feed, (1295.0, 2365.0))

    assert read is not None
    assert edge is not None
    assert (round(read.depth, 2), round(edge.depth, 2)) == (1.0, 1.0)
    assert point_readout(flight.shown, flight.app.feed, None) is None
    assert point_readout(flight.shown, flight.app.feed, (0.0, 0.0)) is None
