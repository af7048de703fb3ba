import msgspec
import pytest

from protocol import Frame, FramePart, InvalidMessage, limits, pack, unpack_server
from tests.protocol.examples import EXAMPLES


def test_a_frame_that_leans_on_itself_is_a_key_frame() -> None:
    frame = EXAMPLES["frame"]
    assert isinstance(frame, Frame)
    assert not frame.is_key
    assert msgspec.structs.replace(frame, key_index=frame.index).is_key


@pytest.mark.parametrize(
    "change",
    [
        {"scale": 0.0},
        {"scale": -0.001},
        {"time": -1.0},
        {"index": -1},
        {"checksum": 2**32},
        {"raw_size": -1},
        {"raw_size": 4 * limits.MAX_CELLS + 1},
        {"states": bytes(limits.MAX_STATE_BYTES + 1)},
    ],
    ids=lambda change: next(iter(change)),
)
def test_a_frame_that_cannot_be_is_refused(change: dict[str, object]) -> None:
    with pytest.raises(InvalidMessage, match=next(iter(change))):
        unpack_server(pack(msgspec.structs.replace(EXAMPLES["frame"], **change)))


def test_a_part_larger_than_allowed_is_refused() -> None:
    with pytest.raises(InvalidMessage, match="data"):
        unpack_server(pack(FramePart("r", 0, 0, 1, bytes(limits.PART_BYTES + 1))))
