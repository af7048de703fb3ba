"""Frames from packed bytes to depth arrays, away from the thread that draws.

Every packed frame that came in is kept (`viewer.world.FrameCache`, within a byte budget), so any of them
can be
shown again without asking the service. A daemon thread decodes what the picture wants next: the key frame
first, then the delta to it. A few decoded frames stay ready.
"""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

import protocol
from viewer.world import FrameCache

__all__ = ["DecodedWater", "FrameKey", "FrameLoader"]

FrameKey = tuple[str, int]
"""Id of the run that holds a frame, and the frame's index."""

PACKED_BYTES_PER_RUN = 768 << 20
DECODED_BYTES = 256 << 20
DECODED_LEAST = 8


@dataclass(frozen=True)
class DecodedWater:
    """The water of one frame.

    Attributes:
        h: depth [m], float32 [nrows, ncols].
        states: block states, uint8 [block_rows, block_cols].
        bed_cells: cells whose bed breaches have moved, flat indices, int64 [k].
        bed_values: their bed [m, datum-relative], float32 [k].
        time: simulation time [s].
        revision: revision of the edits in the bed below this water.
    """

    run: str
    index: int
    time: float
    revision: int
    h: npt.NDArray[np.float32]
    states: npt.NDArray[np.uint8]
    bed_cells: npt.NDArray[np.int64]
    bed_values: npt.NDArray[np.float32]


class FrameLoader:
    """Keeps packed frames by run and index and decodes those that are wanted.

    Args:
        woken: called from the decoding thread after a wanted frame is ready.
        packed_bytes_per_run: byte budget of packed frames, per run.
        decoded_bytes: byte budget of decoded frames.
    """

    def __init__(
        self,
        woken: Callable[[], None] | None = None,
        packed_bytes_per_run: int = PACKED_BYTES_PER_RUN,
        decoded_bytes: int = DECODED_BYTES,
    ) -> None:
        self._woken = woken
        self._packed_bytes = packed_bytes_per_run
        self._decoded_bytes = decoded_bytes
        self._layouts: dict[str, protocol.BlockLayout] = {}
        self._packed: dict[str, FrameCache] = {}
        self._decoders: dict[str, protocol.FrameDecoder] = {}
        self._ready: OrderedDict[FrameKey, DecodedWater] = OrderedDict()
        self._broken: dict[FrameKey, str] = {}
        self._wanted: list[FrameKey] = []
        self._traced_cell = (0, 0)
        self._trace_keys: list[FrameKey] = []
        self._traced: dict[FrameKey, tuple[float, float]] = {}
        self._stopped = False
        self._changed = threading.Condition()
        self._thread = threading.Thread(target=self._decode_wanted, name="fev-frame-loader", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """End the decoding thread. May be called twice."""
        with self._changed:
            self._stopped = True
            self._changed.notify_all()
        self._thread.join()

    def add_run(self, run: str, nrows: int, ncols: int) -> None:
        """Make ready to take frames of `run`, whose grid has `nrows` x `ncols` cells."""
        with self._changed:
            if run not in self._layouts:
                self._layouts[run] = protocol.BlockLayout(nrows, ncols)
                self._packed[run] = FrameCache(self._packed_bytes)
                self._decoders[run] = protocol.FrameDecoder(self._layouts[run])

    def store(self, frame: protocol.Frame) -> list[int] | None:
        """Keep a packed frame; return the indices of the run's frames that had to give way.

        Returns None for a frame of a run that was never announced by `add_run`.
        """
        with self._changed:
            cache = self._packed.get(frame.run)
            if cache is None:
                return None
            gone = cache.store(frame.index, protocol.pack(frame), frame.key_index)
            self._broken.pop((frame.run, frame.index), None)
            self._changed.notify_all()
            return gone

    def has(self, key: FrameKey) -> bool:
        """Whether the packed frame is at hand."""
        with self._changed:
            cache = self._packed.get(key[0])
            return cache is not None and key[1] in cache

    def indices(self, run: str) -> tuple[int, ...]:
        """Return the indices of the frames of `run` that are at hand, in order."""
        with self._changed:
            cache = self._packed.get(run)
            return () if cache is None else cache.indices

    def want(self, keys: Sequence[FrameKey]) -> None:
        """Say which frames are needed, most urgent first; replaces what was wanted before."""
        with self._changed:
            if list(keys) != self._wanted:
                self._wanted = list(keys)
                for run, index in keys[:1]:
                    if run in self._packed:
                        self._packed[run].playhead = index
                self._changed.notify_all()

    def get(self, key: FrameKey) -> DecodedWater | None:
        """Return a frame if it is decoded already."""
        with self._changed:
            water = self._ready.get(key)
            if water is not None:
                self._ready.move_to_end(key)
            return water

    def wait(self, keys: Sequence[FrameKey], timeout_s: float) -> bool:
        """Want `keys` and wait until all are decoded, at most `timeout_s`; return whether they are."""
        self.want(keys)
        with self._changed:
            return self._changed.wait_for(lambda: all(key in self._ready for key in keys), timeout_s)

    def trace(self, row: int, col: int, keys: Sequence[FrameKey]) -> None:
        """Read the depth of one cell in the frames `keys`, whenever nothing more urgent is to be decoded."""
        with self._changed:
            if (row, col) != self._traced_cell:
                self._traced_cell = (row, col)
                self._traced.clear()
            self._trace_keys = [key for key in keys if key not in self._traced]
            self._changed.notify_all()

    def traced(self) -> dict[FrameKey, tuple[float, float]]:
        """Return time [s] and depth [m] of the traced cell in each frame that has been read so far."""
        with self._changed:
            return dict(self._traced)

    def missing_for(self, key: FrameKey) -> int | None:
        """Return the index that must be fetched before `key` can be shown, None when all is at hand."""
        with self._changed:
            cache = self._packed.get(key[0])
            if cache is None or key[1] not in cache:
                return key[1]
            leaned_on = cache.key_of(key[1])
            return leaned_on if leaned_on is not None and leaned_on not in cache else None

    def broken(self, key: FrameKey) -> str | None:
        """Return why a frame cannot be decoded, None when nothing is known against it."""
        with self._changed:
            return self._broken.get(key)

    def _decode_wanted(self) -> None:
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._stopped or self._next() is not None)
                if self._stopped:
                    return
                key = self._next()
                assert key is not None
                is_wanted, cell = key in self._wanted, self._traced_cell
                run, index = key
                cache = self._packed[run]
                leaned_on = cache.key_of(index)
                packed = [cache.get(at) for at in dict.fromkeys((leaned_on, index)) if at is not None]
                decoder = self._decoders[run]
            reason = ""
            decoded: protocol.DecodedFrame | None = None
            try:
                decoded = _decode(decoder, [data for data in packed if data is not None])
                water = _water(decoded) if is_wanted else None
            except protocol.ProtocolError as error:
                reason, water = str(error), None
            with self._changed:
                if decoded is None:
                    self._broken[key] = reason
                elif cell == self._traced_cell and cell < decoded.q.shape:
                    self._traced[key] = (decoded.time, float(decoded.q[cell]) * decoded.scale)
                if water is not None:
                    self._keep(key, water)
                self._changed.notify_all()
            if self._woken is not None:
                self._woken()

    def _next(self) -> FrameKey | None:
        """Return the frame to decode next: the most urgent of those wanted, else one to be traced."""
        for key in self._wanted:
            if key not in self._ready and self._can_decode(key):
                return key
        while self._trace_keys:
            if self._trace_keys[0] not in self._traced and self._can_decode(self._trace_keys[0]):
                return self._trace_keys[0]
            del self._trace_keys[0]
        return None

    def _can_decode(self, key: FrameKey) -> bool:
        cache = self._packed.get(key[0])
        if cache is None or key[1] not in cache or key in self._broken:
            return False
        leaned_on = cache.key_of(key[1])
        return leaned_on is not None and leaned_on in cache

    def _keep(self, key: FrameKey, water: DecodedWater) -> None:
        self._ready[key] = water
        most = max(DECODED_LEAST, self._decoded_bytes // max(water.h.nbytes, 1))
        while len(self._ready) > most:
            oldest = next(iter(self._ready))
            if oldest in self._wanted:
                self._ready.move_to_end(oldest)
                if all(kept in self._wanted for kept in self._ready):
                    break
                continue
            del self._ready[oldest]


def _decode(decoder: protocol.FrameDecoder, packed: Sequence[bytes]) -> protocol.DecodedFrame:
    *leaned_on, wanted = (protocol.unpack_frame(data) for data in packed)
    for key_frame in leaned_on:
        if not decoder.has_key(key_frame.run, key_frame.index):
            decoder.decode(key_frame)
    return decoder.decode(wanted)


def _water(decoded: protocol.DecodedFrame) -> DecodedWater:
    return DecodedWater(
        decoded.run,
        decoded.index,
        decoded.time,
        decoded.revision,
        decoded.h,
        decoded.states,
        decoded.bed_cells,
        decoded.bed_values,
    )
