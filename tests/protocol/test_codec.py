"""Every message survives the wire, has its golden bytes, and refuses what is not it."""

import math
import tracemalloc
from collections.abc import Iterator
from typing import Any

import msgpack
import msgspec
import pytest

import protocol as p
from protocol import limits
from protocol.codec import CLIENT_TYPES, SERVER_TYPES
from tests.protocol.examples import CLIENT_EXAMPLES, CLIENT_KINDS, EXAMPLES, SERVER_EXAMPLES, SERVER_KINDS
from tests.protocol.golden import FOLDER, read_hex

HOSTILE_VALUES = [
    None,
    True,
    -1,
    0,
    2**63,
    -(2**63),
    math.nan,
    math.inf,
    -math.inf,
    1e300,
    "",
    "../../etc/passwd",
    "a" * 65,
    "a\n",
    "x" * 5000,
    b"",
    b"\xff" * 100,
    [],
    [[[]]],
    [math.nan, math.nan],
    {},
    {"op": "hello"},
    {"kind": "line"},
    [1] * 4096,
]


def unpack(name: str, data: bytes) -> p.Message:
    return p.unpack_client(data) if name in CLIENT_EXAMPLES else p.unpack_server(data)


def fields_of(name: str) -> dict[str, Any]:
    fields: dict[str, Any] = msgpack.unpackb(p.pack(EXAMPLES[name]))
    return fields


def leaves(value: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[tuple[Any, ...], Any]]:
    """Path and value of every scalar in nested maps and lists."""
    if isinstance(value, dict):
        for key, item in value.items():
            yield from leaves(item, (*path, key))
    elif isinstance(value, list):
        for key, item in enumerate(value):
            yield from leaves(item, (*path, key))
    else:
        yield path, value


def put(fields: Any, path: tuple[Any, ...], value: Any) -> None:
    for key in path[:-1]:
        fields = fields[key]
    fields[path[-1]] = value


every_example = pytest.mark.parametrize("name", sorted(EXAMPLES))


def test_every_message_has_an_example() -> None:
    assert {type(message) for message in CLIENT_EXAMPLES.values()} == set(CLIENT_KINDS)
    assert {type(message) for message in SERVER_EXAMPLES.values()} == set(SERVER_KINDS)


def test_operations_are_unique_over_both_directions() -> None:
    assert not set(CLIENT_TYPES) & set(SERVER_TYPES)
    assert len(CLIENT_TYPES) == len(CLIENT_KINDS)
    assert len(SERVER_TYPES) == len(SERVER_KINDS)


@every_example
def test_a_message_survives_the_wire(name: str) -> None:
    assert unpack(name, p.pack(EXAMPLES[name])) == EXAMPLES[name]


@every_example
def test_a_message_has_its_golden_bytes(name: str) -> None:
    assert p.pack(EXAMPLES[name]) == read_hex(name)


@every_example
def test_golden_bytes_can_be_read(name: str) -> None:
    assert unpack(name, read_hex(name)) == EXAMPLES[name]


@pytest.mark.parametrize("name", sorted(path.stem for path in (FOLDER / "older").glob("*.hex")))
def test_bytes_of_an_older_peer_can_be_read_and_what_they_lack_has_its_default(name: str) -> None:
    older = msgpack.unpackb(read_hex(f"older/{name}"))
    known = msgspec.to_builtins(unpack(name, read_hex(f"older/{name}")))
    assert _without_later_fields(known, older) == older
    assert known != older


def _without_later_fields(known: Any, older: Any) -> Any:
    if isinstance(older, dict):
        return {key: _without_later_fields(known[key], older[key]) for key in older}
    if isinstance(older, list):
        return [_without_later_fields(a, b) for a, b in zip(known, older, strict=True)]
    return list(known) if isinstance(known, tuple) else known


def test_golden_files_belong_to_examples() -> None:
    assert {path.stem for path in FOLDER.glob("*.hex")} == set(EXAMPLES)


@every_example
def test_a_message_names_its_operation_first(name: str) -> None:
    fields = fields_of(name)
    assert next(iter(fields.items())) == ("op", name.partition("-")[0])


@every_example
def test_a_message_of_the_other_direction_is_unknown(name: str) -> None:
    data = p.pack(EXAMPLES[name])
    wrong_way = p.unpack_server if name in CLIENT_EXAMPLES else p.unpack_client
    with pytest.raises(p.UnknownMessage):
        wrong_way(data)


@every_example
def test_a_message_cut_at_any_byte_is_refused(name: str) -> None:
    data = p.pack(EXAMPLES[name])
    for end in range(len(data)):
        with pytest.raises(p.MalformedMessage):
            unpack(name, data[:end])


@every_example
def test_bytes_after_a_message_are_refused(name: str) -> None:
    with pytest.raises(p.MalformedMessage):
        unpack(name, p.pack(EXAMPLES[name]) + b"\xc0")


@every_example
def test_a_missing_field_is_named_or_has_its_default(name: str) -> None:
    kind = type(EXAMPLES[name])
    for field in msgspec.structs.fields(kind):
        fields = fields_of(name)
        fields.pop(field.encode_name, None)
        data = msgpack.packb(fields)
        if field.required:
            with pytest.raises(p.InvalidMessage, match=field.encode_name):
                unpack(name, data)
        else:
            assert isinstance(unpack(name, data), kind)


@every_example
def test_unknown_fields_are_ignored(name: str) -> None:
    fields = fields_of(name) | {"from_the_future": [1, {"a": 2}]}
    assert unpack(name, msgpack.packb(fields)) == EXAMPLES[name]


@every_example
def test_numbers_that_are_not_finite_are_refused(name: str) -> None:
    floats = [path for path, value in leaves(fields_of(name)) if isinstance(value, float)]
    for path in floats:
        for value in (math.nan, math.inf, -math.inf):
            fields = fields_of(name)
            put(fields, path, value)
            with pytest.raises(p.InvalidMessage):
                unpack(name, msgpack.packb(fields))


@every_example
def test_a_hostile_value_is_refused_or_harmless(name: str) -> None:
    paths = [path for path, _ in leaves(fields_of(name)) if path != ("op",)]
    paths += [(field,) for field in fields_of(name) if field != "op"]
    for path in paths:
        for value in HOSTILE_VALUES:
            fields = fields_of(name)
            put(fields, path, value)
            try:
                message = unpack(name, msgpack.packb(fields))
            except p.ProtocolError:
                continue
            assert unpack(name, p.pack(message)) == message


@every_example
def test_an_operation_of_a_wrong_type_is_unknown(name: str) -> None:
    for value in (None, 3, b"hello", ["hello"], {"hello": 1}):
        with pytest.raises(p.UnknownMessage):
            unpack(name, msgpack.packb(fields_of(name) | {"op": value}))


def test_an_unknown_operation_is_refused_with_the_id_of_the_command() -> None:
    with pytest.raises(p.UnknownMessage, match="drain_the_sea") as caught:
        p.unpack_client(msgpack.packb({"op": "drain_the_sea", "id": 7}))
    assert (caught.value.code, caught.value.message_id) == ("unknown_message", 7)


def test_an_invalid_field_is_refused_with_the_id_of_the_command() -> None:
    with pytest.raises(p.InvalidMessage, match="index") as caught:
        p.unpack_client(msgpack.packb({"op": "seek", "id": 7, "run": "r", "index": "five"}))
    assert caught.value.message_id == 7


@pytest.mark.parametrize("value", [-1, 0, 2**60, True, "7", None, 1.5])
def test_an_id_that_cannot_be_used_is_not_echoed(value: Any) -> None:
    with pytest.raises(p.ProtocolError) as caught:
        p.unpack_client(msgpack.packb({"op": "drain_the_sea", "id": value}))
    assert caught.value.message_id is None


@pytest.mark.parametrize("value", [b"a", "", "r 1", "r/1", "..", "r\n", "\u00e9", "r" * 65, 1])
def test_a_run_id_of_other_characters_is_refused(value: Any) -> None:
    with pytest.raises(p.InvalidMessage):
        p.unpack_client(msgpack.packb({"op": "stop_run", "id": 1, "run": value}))


def test_text_is_not_taken_for_bytes() -> None:
    fields = fields_of("frame") | {"payload": "AAAA"}
    with pytest.raises(p.InvalidMessage):
        p.unpack_server(msgpack.packb(fields))


@pytest.mark.parametrize(
    "data",
    [b"", b"\xc0", b"\x01", b"\x90", b"\xa5hello", b"\xc1", b"\x81\x01\x02", b"\x81\xc4\x02op\xa5hello"],
    ids=["empty", "nil", "number", "array", "text", "reserved", "number-as-key", "bytes-as-key"],
)
def test_what_is_not_a_map_with_text_as_keys_is_malformed(data: bytes) -> None:
    with pytest.raises(p.MalformedMessage):
        p.unpack_client(data)


def test_extension_types_are_malformed() -> None:
    with pytest.raises(p.MalformedMessage):
        p.unpack_client(msgpack.packb({"op": "credit", "frames": msgpack.ExtType(1, b"x")}))


def test_text_that_is_not_utf_8_is_malformed() -> None:
    with pytest.raises(p.MalformedMessage):
        p.unpack_client(b"\x81\xa2op\xa2\xff\xfe")


def test_a_message_above_the_size_limit_is_too_large() -> None:
    with pytest.raises(p.TooLarge):
        p.unpack_client(b"\x00" * (limits.INBOUND_MAX_BYTES + 1))


@pytest.mark.parametrize(
    "data",
    [
        b"\x81\xa1x\xdd\x00\x0f\xff\x00" + b"\x80" * 0xFFF00,
        b"\x81\xa1x" + b"\xdc\x10\x00" + (b"\xdc\x00\xf0" + b"\x80" * 240) * 4096,
        b"\x81\xa1x" + b"\x91" * 1_000_000 + b"\xc0",
        b"\x81\xa1x\xdd\xff\xff\xff\xff",
        b"\x81\xa1x\xdf\xff\xff\xff\xff",
        b"\x81\xa1x\xdb\xff\xff\xff\xff",
    ],
    ids=["many-maps", "nested-maps", "deep-arrays", "long-array", "long-map", "long-text"],
)
def test_a_bomb_is_refused_without_memory(data: bytes) -> None:
    data = data[: limits.INBOUND_MAX_BYTES]
    tracemalloc.start()
    try:
        with pytest.raises(p.TooLarge):
            p.unpack_client(data)
        assert tracemalloc.get_traced_memory()[1] < 2_000_000
    finally:
        tracemalloc.stop()


def test_the_largest_edit_passes_the_limits() -> None:
    vertices = tuple((0.1 + i, 0.2 + i) for i in range(limits.MAX_VERTICES))
    edit = p.EditLine(
        "long", vertices, 5.0, p.Operation.raise_, p.EditType.replace, 2.0, None, (1.5,) * limits.MAX_VERTICES
    )
    message = p.AppendEdit(1, "r", edit)
    assert p.unpack_client(p.pack(message)) == message


def test_the_fullest_edit_list_passes_the_limits() -> None:
    each = limits.MAX_LOG_VERTICES // limits.MAX_EDITS
    edits = tuple(
        p.EditLine(
            f"{number:064d}",
            tuple((0.1 + i, 0.2 + i) for i in range(each)),
            5.1,
            p.Operation.raise_,
            p.EditType.replace,
            2.1,
            None,
            (1.5,) * each,
        )
        for number in range(limits.MAX_EDITS)
    )
    data = p.pack(p.EditsChanged("r", 1, edits, True, False))
    assert len(data) < limits.OUTBOUND_MAX_BYTES
    message = p.unpack_server(data)
    assert isinstance(message, p.EditsChanged)
    assert message.edits == edits


def test_numbers_of_numpy_are_sent_as_plain_ones(rng: Any) -> None:
    x = rng.random(4)
    edit = p.EditLine(
        "a", ((x[0], x[1]), (x[2], x[3])), x.astype("f4")[0], p.Operation.raise_, p.EditType.modulate, 1.0
    )
    message = p.unpack_client(p.pack(p.AppendEdit(1, "r", edit)))
    assert isinstance(message, p.AppendEdit)
    assert message.edit.vertices == ((float(x[0]), float(x[1])), (float(x[2]), float(x[3])))


def test_a_packed_frame_larger_than_a_message_is_read_from_the_store() -> None:
    frame = msgspec.structs.replace(EXAMPLES["frame"], payload=bytes(3 * limits.OUTBOUND_MAX_BYTES))
    data = p.pack(frame)
    assert p.unpack_frame(data) == frame
    assert p.peek_frame(data).key_index == 32
    with pytest.raises(p.TooLarge):
        p.unpack_server(data)
