import msgpack
import msgspec
import pytest

from protocol import (
    AppendEdit,
    AppendEdits,
    EditLine,
    EditLog,
    EditsChanged,
    EditType,
    InvalidMessage,
    Operation,
    limits,
    pack,
    unpack_client,
    unpack_server,
)
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


@pytest.mark.parametrize("listed", [limits.MAX_EDITS, limits.MAX_EDITS // 2])
def test_the_largest_list_with_all_that_was_undone_can_be_sent(listed: int) -> None:
    share = limits.MAX_LOG_VERTICES // limits.MAX_EDITS
    log = EditLog()
    for number in range(limits.MAX_EDITS):
        log.append(
            EditLine(
                id=f"{number:064}",
                vertices=tuple((1234.5 + n, 1e8 / 3.0) for n in range(share)),
                width=1 / 3,
                operation=Operation.raise_,
                type=EditType.replace,
                magnitude=1 / 3,
                level=1 / 3,
                reference_z=tuple(n / 3 for n in range(share)),
                name="\U0001f30a" * 100,
            )
        )
    while len(log.edits) > listed:
        log.undo()
    message = EditsChanged("r" * 64, 2**53, log.edits, True, True, log.undone)
    packed = pack(message)

    assert len(log.edits) + len(log.undone) == limits.MAX_EDITS
    assert len(packed) <= limits.OUTBOUND_MAX_BYTES
    assert unpack_server(packed) == message


def test_as_many_edits_as_can_be_added_at_once_fit_into_a_message() -> None:
    share = limits.MAX_VERTICES // limits.MAX_EDITS_AT_ONCE
    edit = msgspec.structs.replace(
        LINE,
        vertices=tuple((1234.5 + n, 1e8 / 3.0) for n in range(share)),
        reference_z=tuple(n / 3 for n in range(share)),
        name="\U0001f30a" * 100,
    )
    message = AppendEdits(1, "r", (edit,) * limits.MAX_EDITS_AT_ONCE)
    assert unpack_client(pack(message)) == message
    with pytest.raises(InvalidMessage, match="edits"):
        unpack_client(pack(AppendEdits(1, "r", (AREA,) * (limits.MAX_EDITS_AT_ONCE + 1))))
    with pytest.raises(InvalidMessage, match="edits"):
        unpack_client(pack(AppendEdits(1, "r", ())))


def test_the_bytes_of_an_edit_without_a_name_have_no_name() -> None:
    assert "name" not in msgpack.unpackb(pack(AppendEdit(1, "r", LINE)))["edit"]
    named = msgspec.structs.replace(LINE, name="Levee")
    assert msgpack.unpackb(pack(AppendEdit(1, "r", named)))["edit"]["name"] == "Levee"
