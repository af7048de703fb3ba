"""The shape of a msgpack message, looked at before anything is built from it.

A megabyte of empty maps would unpack to sixty times its size; here it costs one pass over the first items.
"""

from __future__ import annotations

from protocol.errors import MalformedMessage, TooLarge
from protocol.limits import MAX_ARRAY_LENGTH, MAX_DEPTH, MAX_MAP_LENGTH

_SCALAR, _SIZED, _ARRAY, _MAP, _REFUSED = range(5)


def _kind_of(lead: int) -> tuple[int, int, int]:
    """Kind of a lead byte, bytes of the length field after it, and the size or length it holds itself."""
    if lead <= 0x7F or lead >= 0xE0 or lead in (0xC0, 0xC2, 0xC3):
        return (_SCALAR, 0, 0)
    if lead <= 0x8F:
        return (_MAP, 0, lead & 0x0F)
    if lead <= 0x9F:
        return (_ARRAY, 0, lead & 0x0F)
    if lead <= 0xBF:
        return (_SCALAR, 0, lead & 0x1F)
    sized = {0xC4: 1, 0xC5: 2, 0xC6: 4, 0xD9: 1, 0xDA: 2, 0xDB: 4}
    fixed = {0xCA: 4, 0xCB: 8, 0xCC: 1, 0xCD: 2, 0xCE: 4, 0xCF: 8, 0xD0: 1, 0xD1: 2, 0xD2: 4, 0xD3: 8}
    containers = {0xDC: (_ARRAY, 2), 0xDD: (_ARRAY, 4), 0xDE: (_MAP, 2), 0xDF: (_MAP, 4)}
    if lead in sized:
        return (_SIZED, sized[lead], 0)
    if lead in fixed:
        return (_SCALAR, 0, fixed[lead])
    if lead in containers:
        return (*containers[lead], 0)
    return (_REFUSED, 0, 0)


_KINDS = tuple(_kind_of(lead) for lead in range(256))


def check_structure(data: bytes, max_items: int) -> None:
    """Walk over the items of one msgpack value.

    Args:
        data: the packed value.
        max_items: most scalars, keys and containers allowed in all.

    Raises:
        MalformedMessage: when the value is cut short, is followed by more, or holds an extension type.
        TooLarge: when it has more items than allowed, an array or map that is too long, or nests too deep.
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
        if kind <= _SIZED:
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
