"""Frames to bytes and back.

A group of up to 32 frames shares one key frame and one scale. The payload covers the cells owned by blocks
that are not dry, in row-major order, as 16-bit numbers: q for a key frame, (q - q_key) mod 65536 for a delta.
They are laid out as `byte_planes` does; frames of older stores have them as they are ("u2"). A delta needs
its key frame and nothing else, so that any other frame may be dropped.
"""

from __future__ import annotations

import zlib
from collections import OrderedDict
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import numpy.typing as npt

from protocol.bed_change import BedCells, pack_bed, unpack_bed
from protocol.blocks import BlockLayout, IntArray, UInt8Array, UInt16Array
from protocol.byte_planes import from_planes, to_planes
from protocol.codec import pack, unpack_frame
from protocol.compression import compress, decompress
from protocol.depth_codec import Q_MAX, FloatArray, choose_depth_scale, dequantise_depth, quantise_depth
from protocol.errors import FrameError, MissingKeyFrame
from protocol.grid import GridGeometry
from protocol.limits import FRAME_GROUP, KEY_FRAMES_KEPT
from protocol.messages import Frame

QuantisedWater = tuple[UInt16Array, UInt8Array]


def _layout_of(grid: GridGeometry | BlockLayout) -> BlockLayout:
    return grid if isinstance(grid, BlockLayout) else BlockLayout(grid.nrows, grid.ncols)


class FrameEncoder:
    """Packs the frames of a run, in order of their index.

    Args:
        grid: grid or block layout.
        group: most frames that share a key frame.
        depth_wet: depth [m] below which a cell is sent as dry, where `encode` is given depths.

    Attributes:
        scale: depth of one unit [m] in the group that is open.
    """

    def __init__(
        self, grid: GridGeometry | BlockLayout, group: int = FRAME_GROUP, depth_wet: float = 1e-3
    ) -> None:
        if not 1 <= group <= FRAME_GROUP:
            raise FrameError(f"A group of {group} frames was asked for; 1 to {FRAME_GROUP} are allowed.")
        self.layout = _layout_of(grid)
        self.group = group
        self.depth_wet = depth_wet
        self.scale = choose_depth_scale(0.0)
        self._run: str | None = None
        self._key_index = 0
        self._key_q: UInt16Array = np.zeros((0, 0), dtype=np.uint16)

    def go_on(self, key: Frame) -> None:
        """Lean the next frames on a key frame that was packed before, as if this encoder had packed it.

        Raises:
            FrameError: when it is no key frame, or does not fit the layout.
        """
        if not key.is_key:
            raise FrameError(f"Frame {key.index} of run {key.run!r} is no key frame.")
        water = FrameDecoder(self.layout).decode(key)
        self._run, self._key_index, self._key_q, self.scale = key.run, key.index, water.q, key.scale

    def choose_scale(self, h_max: float) -> float:
        """Scale [m] for the next frame: the group's while h_max [m] fits, else a coarser one."""
        return self.scale if h_max <= Q_MAX * self.scale else choose_depth_scale(h_max)

    def encode(
        self,
        run: str,
        index: int,
        time: float,
        revision: int,
        water: npt.ArrayLike | QuantisedWater,
        *,
        scale: float | None = None,
        force_key: bool = False,
        bed: BedCells | None = None,
    ) -> bytes:
        """Pack one frame.

        Args:
            run: id of the run.
            index: frame index.
            time: simulated time [s].
            revision: revision of the edits in the bed.
            water: depth h [m], shape [nrows, ncols]; or (q, states) as `quantise_depth` and `classify` give.
            scale: scale [m] of q; by default the group's. Another one than the group's makes a key frame.
            force_key: whether to make a key frame in any case.
            bed: cells that breaches have lowered, as row x ncols + col, rising, and their bed [m].

        Returns:
            The bytes of the `frame` message.

        Raises:
            FrameError: when the water or the bed does not fit the layout or is not finite.
        """
        if isinstance(water, tuple):
            q, states = water
            scale = self.scale if scale is None else scale
        else:
            h = np.asarray(water, dtype=np.float32)
            scale = self._scale_of(h, run, index) if scale is None else scale
            q = quantise_depth(h, scale, self.depth_wet)
            states = self.layout.classify(q)
        if q.shape != (self.layout.nrows, self.layout.ncols) or states.shape != self.layout.shape:
            raise FrameError(
                f"Water has the shapes {q.shape} and {states.shape};"
                f" {(self.layout.nrows, self.layout.ncols)} and {self.layout.shape} are allowed."
            )
        is_key = force_key or scale != self.scale or not self._is_in_group(run, index)
        if is_key:
            self._run, self._key_index, self._key_q, self.scale = run, index, q.copy(), scale
        numbers = self.layout.gather(q, states)
        if not is_key:
            numbers -= self.layout.gather(self._key_q, states)
        raw = to_planes(numbers).data
        bed_cells, bed_values = pack_bed(bed, self.layout)
        return pack(
            Frame(
                run=run,
                index=index,
                time=time,
                revision=revision,
                key_index=self._key_index,
                scale=scale,
                states=self.layout.pack_states(states),
                raw_size=raw.nbytes,
                checksum=_checksum(numbers, bed_cells, bed_values),
                payload=compress(raw),
                bed_cells=bed_cells,
                bed_values=bed_values,
                codec="planes",
            )
        )

    def _is_in_group(self, run: str, index: int) -> bool:
        """Whether a frame may lean on the key frame of the group that is open."""
        return run == self._run and self._key_index < index < self._key_index + self.group

    def _scale_of(self, h: FloatArray, run: str, index: int) -> float:
        h_max = float(h.max(initial=0.0))
        return self.choose_scale(h_max) if self._is_in_group(run, index) else choose_depth_scale(h_max)


@dataclass(frozen=True)
class DecodedFrame:
    """The water of one frame.

    Attributes:
        run: id of the run that holds it.
        index: frame index.
        time: simulated time [s].
        revision: revision of the edits in the bed.
        scale: depth of one unit of q [m].
        q: quantised depth, uint16 [nrows, ncols], read-only.
        states: block states, uint8 [block_rows, block_cols].
        bed_cells: cells whose bed is not base and edits, as row x ncols + col, rising, int64 [k].
        bed_values: their bed [m, relative to the datum offset], float32 [k].
    """

    run: str
    index: int
    time: float
    revision: int
    scale: float
    q: UInt16Array
    states: UInt8Array
    bed_cells: IntArray = field(default_factory=lambda: np.zeros(0, np.int64))
    bed_values: FloatArray = field(default_factory=lambda: np.zeros(0, np.float32))

    @cached_property
    def h(self) -> FloatArray:
        """Depth [m], float32 [nrows, ncols]; computed when first asked for."""
        return dequantise_depth(self.q, self.scale)


class FrameDecoder:
    """Unpacks frames; keeps the latest key frames it saw, so that deltas can be added to them.

    Args:
        grid: grid or block layout.
        keys_kept: how many key frames to keep.
    """

    def __init__(self, grid: GridGeometry | BlockLayout, keys_kept: int = KEY_FRAMES_KEPT) -> None:
        self.layout = _layout_of(grid)
        self._keys_kept = keys_kept
        self._keys: OrderedDict[tuple[str, int], tuple[float, UInt16Array]] = OrderedDict()

    def has_key(self, run: str, key_index: int) -> bool:
        """Whether the deltas of a key frame can be decoded now."""
        return (run, key_index) in self._keys

    def decode(self, frame: Frame) -> DecodedFrame:
        """Unpack one frame.

        Raises:
            MissingKeyFrame: when it is a delta whose key frame is not kept here.
            FrameError: when it does not hold what it declares.
        """
        where = f"Frame {frame.index} of run {frame.run!r}"
        states = self.layout.unpack_states(frame.states)
        raw_size = 2 * self.layout.owned_count(states)
        if frame.raw_size != raw_size:
            raise FrameError(f"{where} declares {frame.raw_size} bytes; its blocks make {raw_size}.")
        raw = decompress(frame.payload, raw_size, raw_size)
        planes = np.frombuffer(raw, np.uint8)
        numbers = from_planes(planes) if frame.codec == "planes" else planes.view("<u2").astype(np.uint16)
        if _checksum(numbers, frame.bed_cells, frame.bed_values) != frame.checksum:
            raise FrameError(f"{where} has the wrong checksum.")
        bed = unpack_bed(frame.bed_cells, frame.bed_values, self.layout)
        if not frame.is_key:
            scale, key_q = self._key_of(frame)
            if scale != frame.scale:
                raise FrameError(f"{where} has the scale {frame.scale!r}, its key frame {scale!r}.")
            numbers += self.layout.gather(key_q, states)
        q = np.zeros((self.layout.nrows, self.layout.ncols), dtype=np.uint16)
        self.layout.scatter(numbers, states, q)
        q.flags.writeable = False
        if frame.is_key:
            self._keep(frame, q)
        return DecodedFrame(frame.run, frame.index, frame.time, frame.revision, frame.scale, q, states, *bed)

    def _key_of(self, frame: Frame) -> tuple[float, UInt16Array]:
        key = self._keys.get((frame.run, frame.key_index))
        if key is None:
            raise MissingKeyFrame(frame.run, frame.key_index)
        return key

    def _keep(self, frame: Frame, q: UInt16Array) -> None:
        name = (frame.run, frame.index)
        self._keys[name] = (frame.scale, q)
        self._keys.move_to_end(name)
        while len(self._keys) > self._keys_kept:
            self._keys.popitem(last=False)


def _checksum(numbers: UInt16Array, bed_cells: bytes, bed_values: bytes) -> int:
    raw = numbers.astype("<u2", copy=False).data
    return zlib.crc32(bed_values, zlib.crc32(bed_cells, zlib.crc32(raw)))


def peek_frame(data: bytes) -> Frame:
    """The fields of a packed frame; its payload stays compressed. Raises as `unpack_client` does."""
    return unpack_frame(data)
