import msgpack
import pytest

from protocol import AppendEdit, EditsChanged, InvalidMessage, limits, pack, unpack_client, unpack_server
from tests.protocol.examples import AREA, LINE


def test_a_list_keeps_edits_of_both_kinds_in_order() -> None:
    message = EditsChanged("r", 3, (LINE, AREA, LINE))
    assert unpack_server(pack(message)) == message


def test_an_edit_of_an_unknown_kind_is_refused() -> None:
    fields = msgpack.unpackb(pack(AppendEdit(1, "r", LINE)))
    fields["edit"]["kind"] = "crater"
    with pytest.raises(InvalidMessage, match="crater"):
        unpack_client(msgpack.packb(fields))


def test_the_rules_of_an_edit_hold_on_the_wire() -> None:
    fields = msgpack.unpackb(pack(AppendEdit(1, "r", LINE)))
    fields["edit"]["reference_z"] = [1.0]
    with pytest.raises(InvalidMessage, match="reference_z"):
        unpack_client(msgpack.packb(fields))


def test_a_longer_list_than_allowed_is_refused() -> None:
    with pytest.raises(InvalidMessage, match="edits"):
        unpack_server(pack(EditsChanged("r", 3, (AREA,) * (limits.MAX_EDITS + 1))))
