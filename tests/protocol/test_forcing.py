import math

import msgspec
import pytest

from protocol import (
    ChangeForcing,
    ForcingChange,
    ForcingError,
    ForcingItem,
    ForcingSeries,
    InvalidMessage,
    check_forcing,
    limits,
    pack,
    unpack_client,
)
from protocol.forcing import thinned
from tests.protocol.examples import CHANGES, ITEMS


def test_changes_that_fit_the_case_are_accepted() -> None:
    check_forcing(CHANGES, ITEMS)
    check_forcing((), ITEMS)


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (ForcingChange("lake"), "no forcing 'lake'; 'spring'"),
        (ForcingChange("spring", factor=-1.0), "'spring' is not valid.*factor"),
        (ForcingChange("spring", factor=600.0), r"comes to 11850 m3/s at 0 s; 0 to 10000 m3/s"),
        (ForcingChange("spring", offset=1.0), "levels alone"),
        (ForcingChange("spring", start_time=3.0), "breaches alone"),
        (ForcingChange("spring", series=ForcingSeries((0.0,), (-1.0,))), "comes to -1 m3/s"),
        (ForcingChange("sea", factor=2.0), "an 'offset' or a 'series' is allowed"),
        (ForcingChange("sea", offset=99.0), "comes to 101.5 m"),
        (ForcingChange("rain", factor=2.0), "the case has no series; give one"),
        (ForcingChange("dam", factor=2.0), "a 'start_time' is allowed"),
        (ForcingChange("dam", series=ForcingSeries((0.0,), (1.0,))), "a 'start_time' is allowed"),
        (ForcingChange("dam", start_time=-1.0), "not valid.*start_time"),
    ],
)
def test_a_change_that_does_not_fit_is_refused_in_words(change: ForcingChange, told: str) -> None:
    with pytest.raises(ForcingError, match=told):
        check_forcing((change,), ITEMS)


def test_an_item_is_changed_once() -> None:
    with pytest.raises(ForcingError, match="twice"):
        check_forcing((ForcingChange("spring"), ForcingChange("spring", 2.0)), ITEMS)


def test_a_series_takes_the_place_of_one_that_the_case_lacks() -> None:
    check_forcing((ForcingChange("rain", factor=2.0, series=ForcingSeries((0.0, 9.0), (5.0, 0.0))),), ITEMS)


def test_the_entries_of_all_series_are_limited_together() -> None:
    half = ForcingSeries(
        tuple(map(float, range(limits.MAX_FORCING_POINTS // 2 + 1))),
        (1.0,) * (limits.MAX_FORCING_POINTS // 2 + 1),
    )
    check_forcing((ForcingChange("spring", series=half),), ITEMS)
    with pytest.raises(ForcingError, match="4098 entries in all; 4096"):
        check_forcing((ForcingChange("spring", series=half), ForcingChange("west-1", series=half)), ITEMS)


@pytest.mark.parametrize(
    ("times", "values", "told"),
    [
        ([0.0, 0.0], [1.0, 2.0], "rising"),
        ([1.0, 0.5], [1.0, 2.0], "rising"),
        ([0.0, 1.0], [1.0], "as many"),
        ([], [], "length"),
        ([0.0], [math.inf], "values"),
        ([math.nan], [1.0], "times"),
    ],
)
def test_a_series_that_cannot_be_is_refused_on_the_wire(
    times: list[float], values: list[float], told: str
) -> None:
    fields = msgspec.msgpack.decode(pack(ChangeForcing(1, "r", (CHANGES[1],))))
    fields["changes"][0]["series"] = {"times": times, "values": values}
    with pytest.raises(InvalidMessage, match=told):
        unpack_client(msgspec.msgpack.encode(fields))


def test_a_breach_begins_at_a_time_or_never_and_at_no_other_word() -> None:
    fields = msgspec.msgpack.decode(pack(ChangeForcing(1, "r", (CHANGES[4],))))
    fields["changes"][0]["start_time"] = "later"
    with pytest.raises(InvalidMessage, match="start_time"):
        unpack_client(msgspec.msgpack.encode(fields))


def test_only_a_change_without_a_difference_is_neutral() -> None:
    assert ForcingChange("spring").is_neutral
    assert not any(change.is_neutral for change in CHANGES)


def test_a_long_series_is_thinned_with_its_ends_and_its_peak() -> None:
    times = [float(k) for k in range(10_000)]
    values = [0.5] * 10_000
    values[4711] = 80.0
    series = thinned(times, values)
    assert len(series.times) <= limits.MAX_ITEM_POINTS
    assert series.times[0] == 0.0
    assert series.times[-1] == 9999.0
    assert series.values[series.times.index(4711.0)] == 80.0


def test_a_short_series_stays_whole() -> None:
    assert thinned([0.0, 3.0], [1.0, 2.0]) == ForcingSeries((0.0, 3.0), (1.0, 2.0))


def test_an_item_of_a_case_is_a_record_of_its_own() -> None:
    assert msgspec.convert(msgspec.to_builtins(ITEMS[5]), ForcingItem) == ITEMS[5]
