from tests.viewer.app.conftest import Flight
from tests.viewer.tiny_service import INTERVAL
from viewer.app.pointing import Pointing
from viewer.commands import MoveHover, Pause, ProbeAt, Seek


def pointing_of(flight: Flight) -> Pointing:
    return Pointing(flight.app.loader, flight.app.feed, flight.app.pointing._flow)


def test_the_pointer_is_followed_and_forgotten(flight: Flight) -> None:
    pointing = pointing_of(flight)
    flight.do(Pause(), Seek(10.5 * INTERVAL))
    flight.settle()
    pointing.take(MoveHover(1285.0, 2365.0), flight.shown)
    read = pointing.report(flight.app.fresh_status(), flight.shown).hover
    pointing.take(MoveHover(None, None), flight.shown)

    assert read is not None
    assert read.depth > 0.5
    assert pointing.report(flight.app.fresh_status(), flight.shown).hover is None


def test_a_probed_point_keeps_a_record_and_one_outside_has_none(flight: Flight) -> None:
    pointing = pointing_of(flight)
    assert pointing.report(flight.app.fresh_status(), flight.shown).depth_record == ((), ())
    pointing.take(ProbeAt(1285.0, 2365.0), flight.shown)
    flight.until(lambda: len(pointing.report(flight.app.fresh_status(), flight.shown).depth_record[0]) >= 5)
    pointing.take(ProbeAt(-1e6, 0.0), flight.shown)

    assert pointing.report(flight.app.fresh_status(), flight.shown).probe is None
