"""What all messages share: field types with their limits, and the check that numbers are finite."""

from __future__ import annotations

import math
import re
from typing import Annotated, Any, ClassVar

import msgspec
import numpy as np
from msgspec import Meta

from protocol.limits import (
    MAX_CELLS,
    MAX_CREDIT,
    MAX_PARTS,
    MAX_SIDE,
)

# \Z, not $: the latter also matches before a trailing line feed.
Identifier = Annotated[str, Meta(pattern=r"^[A-Za-z0-9_-]{1,64}\Z")]
ErrorName = Annotated[str, Meta(pattern=r"^[a-z][a-z0-9_]{0,63}\Z")]
Name = Annotated[str, Meta(max_length=256)]
Text = Annotated[str, Meta(max_length=2000)]
CommandId = Annotated[int, Meta(ge=1, le=2**53)]
FrameIndex = Annotated[int, Meta(ge=0, le=2**31 - 1)]
Revision = Annotated[int, Meta(ge=0, le=2**53)]
Count = Annotated[int, Meta(ge=0, le=2**53)]
Side = Annotated[int, Meta(ge=1, le=MAX_SIDE)]
CreditCount = Annotated[int, Meta(ge=1, le=MAX_CREDIT)]
PartCount = Annotated[int, Meta(ge=1, le=MAX_PARTS)]
PartNumber = Annotated[int, Meta(ge=0, lt=MAX_PARTS)]
Positive = Annotated[float, Meta(gt=0, le=1e12)]
NotNegative = Annotated[float, Meta(ge=0, le=1e18)]
Coordinate = Annotated[float, Meta(ge=-1e9, le=1e9)]
Elevation = Annotated[float, Meta(ge=-20_000, le=20_000)]
RawSize = Annotated[int, Meta(ge=0, le=4 * MAX_CELLS)]


def snake_case(name: str) -> str:
    """Name of an operation: `AppendEdit` is `append_edit`."""
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).lower()


def all_finite(value: Any) -> bool:
    """Whether every float within nested tuples and mappings is finite."""
    if isinstance(value, float):
        return math.isfinite(value)
    if isinstance(value, tuple | list):
        return all(map(all_finite, value))
    if isinstance(value, dict):
        return all(map(all_finite, value.values()))
    return True


def plain(record: msgspec.Struct) -> Any:
    """Maps, lists and numbers that msgpack knows, of a record whose numbers may be NumPy scalars.

    Fields that a record leaves out at their default are not in its map.
    """
    built = msgspec.to_builtins(record, builtin_types=(bytes,), enc_hook=_plain_scalar)
    _leave_out(record, built)
    return built


def _leave_out(value: Any, built: Any) -> None:
    if isinstance(value, WireStruct):
        for name in value.left_out:
            if built[name] == msgspec.to_builtins(_default(type(value), name), builtin_types=(bytes,)):
                del built[name]
        for name in built.keys() & set(value.__struct_fields__):
            _leave_out(getattr(value, name), built[name])
    elif isinstance(value, tuple) and value and isinstance(value[0], WireStruct):
        for item, item_built in zip(value, built, strict=True):
            _leave_out(item, item_built)


def _default(kind: type[WireStruct], name: str) -> Any:
    defaults = kind.__struct_defaults__
    return defaults[kind.__struct_fields__.index(name) - len(kind.__struct_fields__)]


def _plain_scalar(value: Any) -> Any:
    if isinstance(value, np.generic):
        return value.item()
    raise TypeError(f"{type(value).__name__} cannot be sent")


class WireStruct(msgspec.Struct, frozen=True):
    """A frozen record that travels in a message; its numbers are finite.

    Attributes:
        left_out: fields that do not travel while they have their default: what came after the first version,
            so that the bytes of a record that does without it never change.
    """

    left_out: ClassVar[tuple[str, ...]] = ()

    def __post_init__(self) -> None:
        """Refuse NaN and infinities, which msgpack carries as any other number.

        Raises:
            ValueError: naming the field; the codec turns it into `InvalidMessage`.
        """
        for field in self.__struct_fields__:
            if not all_finite(getattr(self, field)):
                raise ValueError(f"Field {field!r} holds a number that is not finite")


class Message(WireStruct, frozen=True, tag_field="op", tag=snake_case):
    """A record that is a whole message; its operation is the class name in snake case."""


class Command(Message, frozen=True):
    """A message of a client that is answered exactly once.

    Attributes:
        id: number chosen by the client, larger than any it used before on this connection.
    """

    id: CommandId
