import msgspec
import pytest

from protocol import (
    ChannelPart,
    GetChannel,
    InvalidMessage,
    StartRun,
    limits,
    pack,
    unpack_client,
    unpack_server,
)
from tests.protocol.examples import EXAMPLES


@pytest.mark.parametrize(
    "change",
    [{"channel": "depth"}, {"channel": ""}, {"index": -1}, {"run": "../r"}],
    ids=lambda change: f"{change}",
)
def test_a_channel_that_there_is_not_cannot_be_asked_for(change: dict[str, object]) -> None:
    command = EXAMPLES["get_channel"]
    assert isinstance(command, GetChannel)
    with pytest.raises(InvalidMessage):
        unpack_client(pack(msgspec.structs.replace(command, **change)))


@pytest.mark.parametrize("channels", [("depth",), ("velocity", "maxima", "velocity")])
def test_a_run_keeps_known_channels_only(channels: tuple[str, ...]) -> None:
    command = StartRun(1, "jacksboro")
    with pytest.raises(InvalidMessage):
        unpack_client(pack(msgspec.structs.replace(command, channels=channels)))


@pytest.mark.parametrize(
    "change",
    [{"parts": 0}, {"part": -1}, {"parts": limits.MAX_PARTS + 1}, {"data": bytes(limits.PART_BYTES + 1)}],
    ids=lambda change: next(iter(change)),
)
def test_a_part_that_cannot_be_is_refused(change: dict[str, object]) -> None:
    part = EXAMPLES["channel_part"]
    assert isinstance(part, ChannelPart)
    with pytest.raises(InvalidMessage):
        unpack_server(pack(msgspec.structs.replace(part, **change)))
