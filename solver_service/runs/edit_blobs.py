"""Edits as the store keeps them: msgpack of the wire's own records."""

from __future__ import annotations

import msgspec

from protocol import Edit


def pack_edit(edit: Edit) -> bytes:
    """One edit."""
    return msgspec.msgpack.encode(edit)


def unpack_edit(packed: bytes) -> Edit:
    """One edit back."""
    edit: Edit = msgspec.msgpack.decode(packed, type=Edit)
    return edit


def pack_edits(edits: tuple[Edit, ...]) -> bytes:
    """An ordered list of edits."""
    return msgspec.msgpack.encode(edits)


def unpack_edits(packed: bytes) -> tuple[Edit, ...]:
    """An ordered list of edits back."""
    edits: tuple[Edit, ...] = msgspec.msgpack.decode(packed, type=tuple[Edit, ...])
    return edits
