"""Recent full-precision states in memory, so that Recalculate need not go to the disk.

States are packed (zstd, level 1) by a background thread; until then they count at their full size. When the
budget is passed, the state goes whose loss leaves the smallest gap in the time line of its run; the newest of
a run stays.
"""

from __future__ import annotations

import threading
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import zstandard
from numpy.typing import NDArray

from solver_service.store import StoredState


@dataclass(frozen=True)
class _PackedArray:
    dtype: str
    shape: tuple[int, ...]
    content: bytes


@dataclass
class _Entry:
    run: str
    time: float
    raw: StoredState | None
    size: int
    packed: dict[str, _PackedArray] = field(default_factory=dict)
    head: StoredState | None = None  # time, step count and scalars of a packed state


class StateRing:
    """States of several runs under one byte budget; safe from several threads."""

    def __init__(self, budget_bytes: int) -> None:
        """An empty ring.

        Args:
            budget_bytes: memory the states may take [bytes]; the newest state is kept even above it.
        """
        self._budget = budget_bytes
        self._entries: list[_Entry] = []
        self._lock = threading.Lock()
        self._pool = ThreadPoolExecutor(4, thread_name_prefix="state-unpack")

    @property
    def size_bytes(self) -> int:
        """Memory in use [bytes]."""
        with self._lock:
            return sum(entry.size for entry in self._entries)

    def times(self, run: str) -> list[float]:
        """Times [s] at which states of a run are held, in order."""
        with self._lock:
            return sorted(entry.time for entry in self._entries if entry.run == run)

    def add(self, run: str, state: StoredState) -> None:
        """Keep a state in place of an equal one; its arrays must not change afterwards."""
        size = sum(array.nbytes for array in state.arrays.values())
        with self._lock:
            self._entries = [e for e in self._entries if (e.run, e.time) != (run, state.time)]
            self._entries.append(_Entry(run, state.time, state, size))
            self._thin()

    def pack_one(self) -> bool:
        """Pack the newest state that is not packed yet.

        Returns:
            Whether there was one.
        """
        with self._lock:
            entry = next((e for e in reversed(self._entries) if e.raw is not None), None)
            state = entry.raw if entry is not None else None
        if entry is None or state is None:
            return False
        packed = {name: _pack(array) for name, array in state.arrays.items()}
        with self._lock:
            entry.packed = packed
            entry.head = StoredState(state.time, state.step_count, {}, state.scalars)
            entry.raw = None
            entry.size = sum(len(array.content) for array in packed.values())
        return True

    def latest(self, run: str, time: float) -> StoredState | None:
        """The newest state of a run at or before a time [s]."""
        with self._lock:
            candidates = [e for e in self._entries if e.run == run and e.time <= time]
            if not candidates:
                return None
            entry = max(candidates, key=lambda e: e.time)
            raw, packed, head = entry.raw, entry.packed, entry.head
        if raw is not None:
            return raw
        assert head is not None
        arrays = dict(zip(packed, self._pool.map(_unpack, packed.values()), strict=True))
        return StoredState(head.time, head.step_count, arrays, head.scalars)

    def clear(self) -> None:
        """Forget everything."""
        with self._lock:
            self._entries = []

    def _thin(self) -> None:
        while len(self._entries) > 1 and sum(entry.size for entry in self._entries) > self._budget:
            self._entries.remove(min(self._entries[:-1], key=self._gap_without))

    def _gap_without(self, entry: _Entry) -> float:
        """Gap in the time line of its run without this entry; the newest counts as twice its gap."""
        times = [e.time for e in self._entries if e.run == entry.run]
        before = max((t for t in times if t < entry.time), default=None)
        after = min((t for t in times if t > entry.time), default=None)
        if before is None:
            return float("inf")  # the first is where a replay begins when all others are gone
        return after - before if after is not None else 2.0 * (entry.time - before)


def _pack(array: NDArray[Any]) -> _PackedArray:
    content = zstandard.ZstdCompressor(level=1).compress(
        np.ascontiguousarray(array).reshape(-1).view(np.uint8).data
    )
    return _PackedArray(array.dtype.str, array.shape, content)


def _unpack(array: _PackedArray) -> NDArray[Any]:
    content = zstandard.ZstdDecompressor().decompress(array.content)
    return np.frombuffer(bytearray(content), array.dtype).reshape(array.shape)
