import time

from tests.viewer.app.conftest import Flight
from viewer.app.traffic import Traffic
from viewer.view_status import ViewStatus


def test_the_rate_is_that_of_the_last_whole_second() -> None:
    traffic = Traffic()
    rates = [
        traffic.note(received, now) for received, now in ((0, 0.0), (500, 0.5), (1000, 1.0), (1000, 2.5))
    ]

    assert rates == [0.0, 0.0, 8000.0, 0.0]


def test_a_counter_that_begins_again_gives_no_negative_rate() -> None:
    traffic = Traffic()
    traffic.note(1000, 0.0)

    assert traffic.note(10, 2.0) == 0.0
    assert traffic.note(135, 3.0) == 1000.0


def test_the_status_tells_traffic_and_the_age_in_whole_seconds(flight: Flight) -> None:
    told = Traffic().report(ViewStatus(), flight.app.desk, time.monotonic() + 3.5)

    assert told.received_bytes == flight.app.desk.connection.received_bytes > 0
    assert told.data_age == 3.0
