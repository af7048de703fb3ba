"""Bytes to message and back: the one place where msgpack is named.

Nothing is believed: size, nesting and number of items are checked before anything is built, then every field
against its type and limits.
"""

from __future__ import annotations

from typing import Any, get_args

import msgpack  # type: ignore[import-untyped]
import msgspec

from protocol.errors import InvalidMessage, MalformedMessage, TooLarge, UnknownMessage
from protocol.fields import plain
from protocol.limits import (
    INBOUND_MAX_BYTES,
    INBOUND_MAX_ITEMS,
    MAX_ARRAY_LENGTH,
    MAX_CHANNEL_BYTES,
    MAX_FRAME_BYTES,
    MAX_MAP_LENGTH,
    MAX_STRING_BYTES,
    OUTBOUND_MAX_BYTES,
    OUTBOUND_MAX_ITEMS,
)
from protocol.messages import Channel, ClientMessage, Frame, Message, Series, ServerMessage
from protocol.structure import check_structure


def operation(message: Message | type[Message]) -> str:
    """The `op` of a message or of its class."""
    return str(message.__struct_config__.tag)


CLIENT_TYPES: dict[str, type[Message]] = {operation(kind): kind for kind in get_args(ClientMessage)}
SERVER_TYPES: dict[str, type[Message]] = {operation(kind): kind for kind in get_args(ServerMessage)}
FRAME_TYPES: dict[str, type[Message]] = {operation(Frame): Frame}
CHANNEL_TYPES: dict[str, type[Message]] = {operation(kind): kind for kind in (Channel, Series)}


def pack(message: Message) -> bytes:
    """A message as msgpack: a map of its fields, `op` first, in the order of their definition."""
    packed: bytes = msgpack.packb(plain(message), use_bin_type=True)
    return packed


def unpack_client(data: bytes) -> ClientMessage:
    """The message of a client.

    Raises:
        TooLarge: when it passes a limit.
        MalformedMessage: when it is not one msgpack map with string keys.
        UnknownMessage: when its operation is not one of a client.
        InvalidMessage: when a field is missing, of the wrong type or out of range.
    """
    message: ClientMessage = _unpack(data, CLIENT_TYPES, INBOUND_MAX_BYTES, INBOUND_MAX_ITEMS)
    return message


def unpack_server(data: bytes) -> ServerMessage:
    """The message of a service; raises as `unpack_client` does."""
    message: ServerMessage = _unpack(data, SERVER_TYPES, OUTBOUND_MAX_BYTES, OUTBOUND_MAX_ITEMS)
    return message


def unpack_frame(data: bytes) -> Frame:
    """A packed frame, from a store or put together from parts; raises as `unpack_client` does."""
    frame: Frame = _unpack(data, FRAME_TYPES, MAX_FRAME_BYTES, INBOUND_MAX_ITEMS)
    return frame


def unpack_channel(data: bytes) -> Channel | Series:
    """A packed channel or series, from a store or put together from parts; raises as `unpack_client` does."""
    channel: Channel | Series = _unpack(data, CHANNEL_TYPES, MAX_CHANNEL_BYTES, INBOUND_MAX_ITEMS)
    return channel


def _unpack(data: bytes, types: dict[str, type[Message]], max_bytes: int, max_items: int) -> Any:
    fields = _unpack_fields(data, max_bytes, max_items)
    message_id = _readable_id(fields)
    op = fields.get("op")
    kind = types.get(op) if isinstance(op, str) else None
    if kind is None:
        shown = repr(op) if len(repr(op)) <= 80 else f"{repr(op)[:77]}..."
        raise UnknownMessage(f"There is no operation {shown} in this direction.", message_id=message_id)
    try:
        # builtin_types: without it text would be taken for base64 where bytes are wanted.
        return msgspec.convert(fields, kind, builtin_types=(bytes,))
    except msgspec.ValidationError as error:
        raise InvalidMessage(f"Message {op!r} is not valid: {error}.", message_id=message_id) from error


def _unpack_fields(data: bytes, max_bytes: int, max_items: int) -> dict[str, Any]:
    if len(data) > max_bytes:
        raise TooLarge(f"A message has {len(data)} bytes; up to {max_bytes} are allowed.")
    check_structure(data, max_items)
    try:
        fields = msgpack.unpackb(
            data,
            raw=False,
            strict_map_key=True,
            max_str_len=MAX_STRING_BYTES,
            max_bin_len=max_bytes,
            max_array_len=MAX_ARRAY_LENGTH,
            max_map_len=MAX_MAP_LENGTH,
            max_ext_len=0,
        )
    except (ValueError, msgpack.UnpackException) as error:
        raise MalformedMessage(f"A message is not valid msgpack: {error}.") from error
    if not isinstance(fields, dict) or not all(isinstance(key, str) for key in fields):
        raise MalformedMessage("A message is not a msgpack map with text as keys.")
    return fields


def _readable_id(fields: dict[str, Any]) -> int | None:
    value = fields.get("id")
    return value if type(value) is int and 1 <= value <= 2**53 else None
