import time

import msgspec
import numpy as np
import pytest

import protocol
from protocol.codec import unpack_channel
from tests.viewer.tiny_service import INTERVAL, NCOLS, NROWS, channel, wait_for
from viewer.net import ChannelKey, ChannelLoader

LAYOUT = protocol.BlockLayout(NROWS, NCOLS)


def store(loader: ChannelLoader, index: int, name: protocol.ChannelName) -> ChannelKey:
    key = ("r", index, name)
    loader.store(key, unpack_channel(channel("r", index, name)), LAYOUT)
    return key


@pytest.fixture
def loader():
    made = ChannelLoader()
    yield made
    made.close()


def test_velocity_comes_with_its_speed_and_a_speed_that_little_water_exceeds(loader: ChannelLoader) -> None:
    key = store(loader, 12, "velocity")
    wait_for(lambda: loader.get(key) is not None)
    fields = loader.get(key)

    assert fields is not None
    assert (fields.index, fields.time) == (12, 12 * INTERVAL)
    assert fields.fields["speed"].max() == pytest.approx(1.2, abs=1e-3)
    assert np.array_equal(fields.fields["speed"], np.hypot(fields.fields["u"], fields.fields["v"]))
    assert fields.fast == pytest.approx(1.2, abs=1e-3)
    assert loader.ready("velocity") == [key]
    assert loader.ready("maxima") == []


def test_where_water_never_came_maxima_are_negative(loader: ChannelLoader) -> None:
    key = store(loader, 10, "maxima")
    wait_for(lambda: loader.get(key) is not None)
    fields = loader.get(key)

    assert fields is not None
    wet = fields.fields["max_depth"] > 0.0
    assert 0.0 < wet.mean() < 1.0
    for name in ("max_depth", "max_speed", "max_hazard", "arrival"):
        assert (fields.fields[name][~wet] < 0.0).all()
        assert (fields.fields[name][wet] >= 0.0).all()


def test_what_is_kept_stays_within_the_budget_and_the_newest_stays() -> None:
    each = 3 * 4 * NROWS * NCOLS
    loader = ChannelLoader(byte_budget=6 * each)
    for index in range(1, 12):
        key = store(loader, index, "velocity")
        wait_for(lambda key=key: loader.get(key) is not None)

    assert [key[1] for key in loader.ready("velocity")] == [6, 7, 8, 9, 10, 11]
    loader.close()


def test_a_broken_channel_is_told_and_nothing_else_suffers(loader: ChannelLoader) -> None:
    broken = msgspec.structs.replace(unpack_channel(channel("r", 3, "velocity")), checksum=1)
    loader.store(("r", 3, "velocity"), broken, LAYOUT)
    wait_for(lambda: loader.broken(("r", 3, "velocity")) is not None)

    assert "checksum" in (loader.broken(("r", 3, "velocity")) or "")
    key = store(loader, 4, "velocity")
    wait_for(lambda: loader.get(key) is not None)


def test_the_speed_of_one_cell_is_noted_in_all_that_is_ready_and_comes(loader: ChannelLoader) -> None:
    first = store(loader, 5, "velocity")
    wait_for(lambda: loader.get(first) is not None)
    loader.trace(NROWS // 2, 4)
    second = store(loader, 8, "velocity")
    wait_for(lambda: loader.get(second) is not None)

    traced = loader.traced()
    assert traced[first] == (5 * INTERVAL, pytest.approx(0.5, abs=1e-3))
    assert traced[second] == (8 * INTERVAL, pytest.approx(0.8, abs=1e-3))
    loader.trace(0, 0)
    assert {speed for _, speed in loader.traced().values()} == {0.0}


def test_it_can_be_closed_twice() -> None:
    loader = ChannelLoader()
    loader.close()
    begun = time.monotonic()
    loader.close()

    assert time.monotonic() - begun < 1.0
