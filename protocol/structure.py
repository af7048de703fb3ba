"""The shape of a msgpack message, looked at before anything is built from it.

A megabyte of empty maps would unpack to sixty times its size; here it costs one pass over the first items.
"""

from __future__ import annotations

from protocol.errors import MalformedMessage, TooLarge
from protocol.limits import MAX_ARRAY_LENGTH, MAX_DEPTH, MAX_MAP_LENGTH, MAX_STRING_BYTES

_SCALAR, _TEXT, _ARRAY, _MAP, _REFUSED = range(5)


def _kind_of(lead: int) -> tuple[int, int, int]:
    """Kind of a lead byte, bytes of the length field after it, and the size or length it holds itself."""
    if lead <= 0x7F or lead >= 0xE0 or lead in (0xC0, 0xC2, 0xC3):
        return (_SCALAR, 0, 0)
    if lead <= 0x8F:
        return (_MAP, 0, lead & 0x0F)
    if lead <= 0x9F:
        return (_ARRAY, 0, lead & 0x0F)
    if lead <= 0xBF:
        return (_TEXT, 0, lead & 0x1F)
    sized = {
        0xC4: (_SCALAR, 1),
        0xC5: (_SCALAR, 2),
        0xC6: (_SCALAR, 4),
        0xD9: (_TEXT, 1),
        0xDA: (_TEXT, 2),
        0xDB: (_TEXT, 4),
        0xDC: (_ARRAY, 2),
        0xDD: (_ARRAY, 4),
        0xDE: (_MAP, 2),
        0xDF: (_MAP, 4),
    }
    fixed = {0xCA: 4, 0xCB: 8, 0xCC: 1, 0xCD: 2, 0xCE: 4, 0xCF: 8, 0xD0: 1, 0xD1: 2, 0xD2: 4, 0xD3: 8}
    if lead in sized:
        return (*sized[lead], 0)
    if lead in fixed:
        return (_SCALAR, 0, fixed[lead])
    return (_REFUSED, 0, 0)


_KINDS = tuple(_kind_of(lead) for lead in range(256))


def check_structure(data: bytes, max_items: int) -> None:
    """Walk over the items of one msgpack value.

    Args:
        data: the packed value.
        max_items: most scalars, keys and containers allowed in all.

    Raises:
        MalformedMessage: when the value is cut short, is followed by more, or holds an extension type.
        TooLarge: when it has too many items, an array, map or text that is too long, or nests too deep.
    """
    size = len(data)
    position = 0
    items = 0
    # Items still to come in each open container, the innermost last.
    open_counts = [1]
    while open_counts:
        if open_counts[-1] == 0:
            open_counts.pop()
            continue
        open_counts[-1] -= 1
        items += 1
        if items > max_items:
            raise TooLarge(f"A message has more than {max_items} items.")
        if position >= size:
            raise MalformedMessage("A message is cut short.")
        kind, length_bytes, count = _KINDS[data[position]]
        position += 1
        if length_bytes:
            count = int.from_bytes(data[position : position + length_bytes], "big")
            position += length_bytes
        if kind <= _TEXT:
            if kind == _TEXT and count > MAX_STRING_BYTES:
                raise TooLarge(
                    f"A message has a text of {count} bytes; up to {MAX_STRING_BYTES} are allowed."
                )
            position += count
            continue
        if kind == _REFUSED:
            raise MalformedMessage("A message holds an extension type or a reserved byte.")
        limit = MAX_ARRAY_LENGTH if kind == _ARRAY else MAX_MAP_LENGTH
        if count > limit:
            raise TooLarge(f"A message has an array or map of {count} items; up to {limit} are allowed.")
        if len(open_counts) > MAX_DEPTH:
            raise TooLarge(f"A message nests deeper than {MAX_DEPTH} levels.")
        open_counts.append(count if kind == _ARRAY else 2 * count)
    if position != size:
        raise MalformedMessage("A message is cut short or followed by more bytes.")
