import pytest

from protocol import (
    ChangeForcing,
    ForcingChange,
    ForcingChanged,
    ForcingItem,
    ForcingSeries,
    InvalidMessage,
    RunChanged,
    StartRun,
    limits,
    pack,
    unpack_client,
    unpack_server,
)
from tests.protocol.examples import CHANGES, ITEMS, RUN


def test_an_empty_list_is_the_case_as_it_is() -> None:
    message = ChangeForcing(1, "r", ())
    assert unpack_client(pack(message)) == message


def test_a_longer_list_than_allowed_is_refused() -> None:
    changes = (ForcingChange("spring"),) * (limits.MAX_FORCING_CHANGES + 1)
    with pytest.raises(InvalidMessage, match="changes"):
        unpack_client(pack(ChangeForcing(1, "r", changes)))


def test_the_largest_lists_pass_in_both_directions() -> None:
    many = tuple(map(float, range(limits.MAX_FORCING_POINTS)))
    changes = (ForcingChange("a", series=ForcingSeries(many, many)),)
    changes += tuple(ForcingChange(f"b{k}") for k in range(limits.MAX_FORCING_CHANGES - 1))
    command = ChangeForcing(1, "r", changes)
    assert len(pack(command)) < limits.INBOUND_MAX_BYTES
    assert unpack_client(pack(command)) == command
    some = ForcingSeries(many[: limits.MAX_ITEM_POINTS], many[: limits.MAX_ITEM_POINTS])
    item = ForcingItem("a", "source", "m3/s", series=some)
    told = ForcingChanged("r", 1, changes, changes, (item,) * limits.MAX_FORCING_ITEMS)
    assert len(pack(told)) < limits.OUTBOUND_MAX_BYTES
    assert unpack_server(pack(told)) == told


def test_a_run_may_start_with_changes() -> None:
    message = StartRun(1, "jacksboro", forcing=CHANGES)
    assert unpack_client(pack(message)) == message


def test_runs_without_changed_forcing_have_the_bytes_they_had_before() -> None:
    assert b"forcing" not in pack(RunChanged(RUN))
    assert b"forcing" not in pack(StartRun(1, "jacksboro"))


def test_watchers_are_told_what_the_case_has() -> None:
    message = ForcingChanged("r", 2, CHANGES, (), ITEMS)
    assert unpack_server(pack(message)) == message
