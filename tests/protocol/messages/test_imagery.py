import msgspec
import pytest

from protocol import (
    GetImagery,
    ImageryPart,
    InvalidMessage,
    RunChanged,
    limits,
    pack,
    unpack_client,
    unpack_server,
)
from tests.protocol.examples import EXAMPLES, RUN


@pytest.mark.parametrize("change", [{"layer": "ortho"}, {"layer": ""}, {"run": "../r"}], ids=str)
def test_a_picture_that_there_is_not_cannot_be_asked_for(change: dict[str, object]) -> None:
    command = EXAMPLES["get_imagery"]
    assert isinstance(command, GetImagery)
    with pytest.raises(InvalidMessage):
        unpack_client(pack(msgspec.structs.replace(command, **change)))


@pytest.mark.parametrize(
    "change",
    [{"parts": 0}, {"part": -1}, {"layer": "relief"}, {"data": bytes(limits.PART_BYTES + 1)}],
    ids=lambda change: next(iter(change)),
)
def test_a_part_that_cannot_be_is_refused(change: dict[str, object]) -> None:
    part = EXAMPLES["imagery_part"]
    assert isinstance(part, ImageryPart)
    with pytest.raises(InvalidMessage):
        unpack_server(pack(msgspec.structs.replace(part, **change)))


def test_a_run_tells_which_pictures_it_has_and_without_any_is_packed_as_ever() -> None:
    told = unpack_server(pack(RunChanged(msgspec.structs.replace(RUN, layers=("imagery", "walls")))))
    assert isinstance(told, RunChanged)
    assert told.run.layers == ("imagery", "walls")
    assert b"layers" not in pack(RunChanged(RUN))
