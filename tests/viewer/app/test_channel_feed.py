from collections.abc import Iterator

import pytest

from tests.viewer.app.conftest import Flight
from tests.viewer.tiny_service import TinyService
from viewer.app.channel_feed import UNDER_WAY_MOST, ChannelFeed


@pytest.fixture
def feed(flight: Flight) -> ChannelFeed:
    return flight.app.water._channels


@pytest.fixture
def bare() -> Iterator[Flight]:
    service = TinyService(computed=20)
    service.channels = ()
    made = Flight(service)
    made.have_frames(20)
    yield made
    made.close()


def test_a_channel_comes_when_it_is_wanted_and_is_asked_for_once(flight: Flight, feed: ChannelFeed) -> None:
    key = ("run-1", 7, "velocity")
    assert feed.get(key) is None
    for _ in range(5):
        feed.want([key])
    flight.until(lambda: feed.get(key) is not None)
    feed.want([key])
    flight.until(lambda: feed.is_idle)

    assert flight.service.channels_asked == [(7, "velocity")]


def test_of_many_wishes_only_the_newest_are_asked_for(flight: Flight, feed: ChannelFeed) -> None:
    for index in range(12):
        feed.want([("run-1", index, "velocity")])  # as a clock that outruns the service
    flight.until(lambda: feed.is_idle)
    feed.want([("run-1", 12, "velocity")])
    flight.until(lambda: feed.get(("run-1", 12, "velocity")) is not None)

    assert len(flight.service.channels_asked) == UNDER_WAY_MOST + 1


def test_what_a_run_does_not_keep_is_never_asked_for(bare: Flight) -> None:
    feed = bare.app.water._channels
    feed.want([("run-1", 3, "velocity"), ("run-1", 3, "maxima")])
    bare.settle()

    assert feed.is_idle
    assert bare.service.channels_asked == []
    assert not feed.keeps("run-1", "velocity")


def test_a_refused_channel_is_not_asked_for_again_at_once(flight: Flight, feed: ChannelFeed) -> None:
    key = ("run-1", 30, "velocity")  # not computed yet
    feed.want([key])
    flight.until(lambda: feed.is_idle)
    feed.want([key])

    assert feed.is_idle
    assert flight.service.channels_asked == [(30, "velocity")]


def test_after_a_lost_connection_channels_come_again(flight: Flight, feed: ChannelFeed) -> None:
    flight.service.cut()
    flight.until(lambda: not flight.app.desk.is_open)
    feed.want([("run-1", 5, "velocity")])
    assert feed.is_idle
    flight.until(lambda: flight.app.desk.is_open)

    def has_come() -> bool:
        feed.want([("run-1", 5, "velocity")])
        return feed.get(("run-1", 5, "velocity")) is not None

    flight.until(has_come)
