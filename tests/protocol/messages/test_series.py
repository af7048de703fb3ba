import msgspec
import pytest

from protocol import GetSeries, InvalidMessage, Series, limits, pack, unpack_channel, unpack_client


@pytest.mark.parametrize("change", [{"from_index": -1}, {"run": ""}, {"from_index": 2**31}], ids=str)
def test_series_that_cannot_be_cannot_be_asked_for(change: dict[str, object]) -> None:
    with pytest.raises(InvalidMessage):
        unpack_client(pack(msgspec.structs.replace(GetSeries(1, "r"), **change)))


def test_without_an_index_all_is_meant() -> None:
    command = unpack_client(pack(GetSeries(1, "r")))
    assert isinstance(command, GetSeries)
    assert command.from_index == 0


@pytest.mark.parametrize(
    "change",
    [{"times": bytes(limits.MAX_SERIES_BYTES + 8)}, {"gauges": ("g" * 300,)}, {"index": -1}],
    ids=lambda change: next(iter(change)),
)
def test_series_beyond_the_limits_are_refused(change: dict[str, object]) -> None:
    series = Series("r", 0, b"", (), b"", (), b"")
    with pytest.raises(InvalidMessage):
        unpack_channel(pack(msgspec.structs.replace(series, **change)))
