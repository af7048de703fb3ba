import msgspec
import pytest

from protocol import InvalidMessage, Terrain, limits, pack, unpack_server
from tests.protocol.examples import EXAMPLES


@pytest.mark.parametrize(
    "change",
    [
        {"codec": "zip"},
        {"shape": (120,)},
        {"shape": (0, 200)},
        {"parts": 0},
        {"part": -1},
        {"parts": limits.MAX_PARTS + 1},
        {"data": bytes(limits.PART_BYTES + 1)},
    ],
    ids=lambda change: next(iter(change)),
)
def test_a_part_that_cannot_be_is_refused(change: dict[str, object]) -> None:
    terrain = EXAMPLES["terrain"]
    assert isinstance(terrain, Terrain)
    with pytest.raises(InvalidMessage):
        unpack_server(pack(msgspec.structs.replace(terrain, **change)))
