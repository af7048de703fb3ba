"""Putting the parts of a large frame or terrain together, within limits."""

from __future__ import annotations

from protocol.errors import SequenceError, TooLarge
from protocol.limits import MAX_PARTS


class PartAssembler:
    """Joins the parts of one thing at a time. Parts come in order; a thing begun is finished before the next.

    Args:
        what: name of the thing, for errors.
        max_bytes: largest whole.
    """

    def __init__(self, what: str, max_bytes: int) -> None:
        self._what = what
        self._max_bytes = max_bytes
        self._identity: object = None
        self._data = bytearray()
        self._next_part = 0

    def add(self, identity: object, part: int, parts: int, data: bytes) -> bytes | None:
        """Take the next part.

        Args:
            identity: what tells this thing from others; the same for all its parts.
            part: number of the part, from 0.
            parts: number of parts.
            data: its bytes.

        Returns:
            The whole after the last part, else none.

        Raises:
            SequenceError: when another part was due.
            TooLarge: when the whole passes the limits.
        """
        if self._next_part == 0:
            self._identity = (identity, parts)
        if part != self._next_part or part >= parts or self._identity != (identity, parts):
            raise SequenceError(
                f"Part {part} of {parts} of a {self._what} came where part {self._next_part} was due."
            )
        if parts > MAX_PARTS or len(self._data) + len(data) > self._max_bytes:
            raise TooLarge(f"A {self._what} passes the limit of {self._max_bytes} bytes.")
        self._data += data
        self._next_part += 1
        if self._next_part < parts:
            return None
        whole = bytes(self._data)
        self._data = bytearray()
        self._next_part = 0
        return whole
