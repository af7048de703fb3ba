"""Frames as they came over the wire, within a byte budget.

A frame that is a delta is of no use without its key frame, so a key frame goes only after every frame that
leans on it. What lies farthest from the playhead goes first.
"""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["FrameCache"]


@dataclass(frozen=True)
class _Entry:
    data: bytes
    key_index: int


class FrameCache:
    """Encoded frames by index; the bytes kept never pass the budget, except for one frame and its key.

    Attributes:
        byte_budget: how many bytes may be kept.
        size_bytes: how many are kept now.
        playhead: index near which frames are worth most.
    """

    def __init__(self, byte_budget: int) -> None:
        """Begin empty.

        Args:
            byte_budget: how many bytes may be kept, > 0.
        """
        if byte_budget <= 0:
            raise ValueError(f"frame cache budget {byte_budget!r} must be > 0 bytes")
        self.byte_budget = byte_budget
        self.size_bytes = 0
        self.playhead = 0
        self._entries: dict[int, _Entry] = {}

    def __len__(self) -> int:
        """How many frames are kept."""
        return len(self._entries)

    def __contains__(self, index: int) -> bool:
        """Whether a frame is kept."""
        return index in self._entries

    @property
    def indices(self) -> tuple[int, ...]:
        """Indices of the frames kept, in order."""
        return tuple(sorted(self._entries))

    def get(self, index: int) -> bytes | None:
        """The bytes of a frame, or None if it is not kept."""
        entry = self._entries.get(index)
        return None if entry is None else entry.data

    def key_of(self, index: int) -> int | None:
        """The index of the key frame that a kept frame leans on (its own if it is one)."""
        entry = self._entries.get(index)
        return None if entry is None else entry.key_index

    def store(self, index: int, data: bytes, key_index: int) -> list[int]:
        """Keep a frame, making room if need be.

        Args:
            index: frame index.
            data: encoded bytes.
            key_index: index of its group's key frame; equal to index for a key frame.

        Returns:
            the indices that had to go, in the order in which they went.
        """
        old = self._entries.pop(index, None)
        self.size_bytes += len(data) - (0 if old is None else len(old.data))
        self._entries[index] = _Entry(data, key_index)
        return self._evict(keep=index)

    def drop_from(self, index: int) -> list[int]:
        """Forget every frame from an index on, and return which they were."""
        gone = [k for k in self._entries if k >= index]
        for k in gone:
            self._remove(k)
        return sorted(gone)

    def clear(self) -> None:
        """Forget everything."""
        self._entries.clear()
        self.size_bytes = 0

    def _evict(self, keep: int) -> list[int]:
        gone: list[int] = []
        while self.size_bytes > self.byte_budget and len(self._entries) > 1:
            leaned_on = {entry.key_index for k, entry in self._entries.items() if entry.key_index != k}
            free = [k for k in self._entries if k not in leaned_on and k != keep]
            if not free:
                break
            farthest = max(free, key=lambda k: (abs(k - self.playhead), k))
            self._remove(farthest)
            gone.append(farthest)
        return gone

    def _remove(self, index: int) -> None:
        self.size_bytes -= len(self._entries.pop(index).data)
