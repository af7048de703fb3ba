"""Channels to bytes and back: velocity and maxima as 16-bit fixed point, one scale a field.

The payload covers the cells owned by blocks that are not dry, in row-major order, field after field, each as
`byte_planes` orders it. Signed fields are two's complement; a time that has not come is 65535.
"""

from __future__ import annotations

import math
import zlib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import get_args

import numpy as np

from protocol.blocks import BlockLayout, UInt8Array, UInt16Array
from protocol.byte_planes import from_planes, to_planes
from protocol.codec import pack
from protocol.compression import compress, decompress
from protocol.depth_codec import FloatArray
from protocol.errors import FrameError
from protocol.limits import MAX_CHANNEL_BYTES, PART_BYTES
from protocol.messages import Channel, ChannelName, ChannelPart

CHANNEL_NAMES: tuple[ChannelName, ...] = get_args(ChannelName)

CHANNEL_FIELDS: Mapping[ChannelName, tuple[str, ...]] = {
    "velocity": ("u", "v"),
    "maxima": ("max_depth", "max_speed", "max_hazard", "arrival_time"),
}
"""Fields of each channel, in their order: m/s east and north; m, m/s, 1, s (inf where never)."""

SIGNED = frozenset(("u", "v"))
TIMES = frozenset(("arrival_time",))

LEVELS = 4095
"""Most units that the largest value of a field takes: a scale is 1/4095 to 1/1638 of it."""

FINEST = 1e-6
"""Finest scale."""

NEVER = 65535
"""Code of a time that has not come."""


@dataclass(frozen=True)
class DecodedChannel:
    """A channel of one frame.

    Attributes:
        run: id of the run that holds the frame.
        index: frame index.
        time: simulated time [s].
        channel: name of the channel.
        fields: float32 [nrows, ncols] by name: `u`, `v` [m/s to the east and north]; or `max_depth` [m],
            `max_speed` [m/s], `max_hazard`, `arrival_time` [s, inf where never]. 0 where the channel carries
            nothing.
        error_bounds: largest error of each field, by name, in its unit; float32 rounding aside.
    """

    run: str
    index: int
    time: float
    channel: ChannelName
    fields: Mapping[str, FloatArray]
    error_bounds: Mapping[str, float]


def choose_scale(largest: float) -> float:
    """Finest scale of the series 1, 2, 5, 10, ... in which a value takes `LEVELS` units at most.

    Raises:
        FrameError: when the value is not finite.
    """
    if not math.isfinite(largest):
        raise FrameError(f"The largest value of a channel is {largest!r}; a finite one is allowed.")
    wanted = max(largest / LEVELS, FINEST)
    exponent = math.floor(math.log10(wanted)) - 1
    while True:
        for digit in (1, 2, 5):
            scale = digit * 10.0**exponent if exponent >= 0 else digit / 10.0**-exponent
            if scale >= wanted:
                return scale
        exponent += 1


def encode_channel(
    layout: BlockLayout,
    run: str,
    index: int,
    time: float,
    channel: ChannelName,
    fields: Mapping[str, FloatArray],
    states: UInt8Array,
) -> bytes:
    """Pack a channel of one frame.

    Args:
        layout: blocks of the grid.
        run: id of the run.
        index: frame index.
        time: simulated time [s].
        channel: name of the channel.
        fields: the fields of the channel by name, float32 [nrows, ncols]; times are inf where never.
        states: block states; cells owned by dry blocks are left out.

    Returns:
        The bytes of the `channel` message.

    Raises:
        FrameError: when a field has another shape or holds a number that is not finite.
    """
    planes, scales = [], []
    for name in CHANNEL_FIELDS[channel]:
        values = fields[name]
        if values.shape != (layout.nrows, layout.ncols):
            shape = (layout.nrows, layout.ncols)
            raise FrameError(f"Field {name} has the shape {values.shape}; {shape} is allowed.")
        numbers, scale = _quantise(name, layout.gather(values, states))
        planes.append(to_planes(numbers))
        scales.append(scale)
    raw = np.concatenate(planes).data.cast("B")
    return pack(
        Channel(
            run=run,
            index=index,
            time=time,
            channel=channel,
            states=layout.pack_states(states),
            scales=tuple(scales),
            raw_size=raw.nbytes,
            checksum=zlib.crc32(raw),
            payload=compress(raw),
        )
    )


def _quantise(name: str, values: FloatArray) -> tuple[UInt16Array, float]:
    come = values != np.float32(np.inf) if name in TIMES else None
    known = values if come is None else values[come]
    low, high = (float(known.min()), float(known.max())) if known.size else (0.0, 0.0)
    if not (math.isfinite(low) and (low >= 0.0 or name in SIGNED)):
        raise FrameError(f"Field {name} goes down to {low!r}, which it cannot.")
    scale = choose_scale(max(-low, high))
    if come is not None:
        values = np.where(come, values, np.float32(0.0))
    units = np.rint(values / np.float32(scale))
    numbers = units.astype(np.int16).view(np.uint16)
    if come is not None:
        numbers[~come] = NEVER
    return numbers, scale


def channel_parts(command_id: int, packed: bytes) -> Iterator[ChannelPart]:
    """A packed channel as the messages that carry it.

    Args:
        command_id: id of the `get_channel` that asked.
        packed: the bytes of the `channel` message.
    """
    parts = -(-len(packed) // PART_BYTES)
    for part in range(parts):
        data = packed[part * PART_BYTES : (part + 1) * PART_BYTES]
        yield ChannelPart(id=command_id, part=part, parts=parts, data=data)


def decode_channel(layout: BlockLayout, packed: Channel) -> DecodedChannel:
    """Unpack a channel.

    Raises:
        FrameError: when it does not hold what it declares.
        TooLarge: when it declares more than the limits allow.
    """
    where = f"Channel {packed.channel} of frame {packed.index} of run {packed.run!r}"
    names = CHANNEL_FIELDS[packed.channel]
    if len(packed.scales) != len(names):
        raise FrameError(f"{where} has {len(packed.scales)} scales; {len(names)} are allowed.")
    states = layout.unpack_states(packed.states)
    count = layout.owned_count(states)
    raw_size = 2 * len(names) * count
    if packed.raw_size != raw_size:
        raise FrameError(f"{where} declares {packed.raw_size} bytes; its blocks make {raw_size}.")
    raw = decompress(packed.payload, raw_size, MAX_CHANNEL_BYTES)
    if zlib.crc32(raw) != packed.checksum:
        raise FrameError(f"{where} has the wrong checksum.")
    planes = np.frombuffer(raw, np.uint8).reshape(len(names), 2 * count)
    fields = {
        name: _field(name, from_planes(plane), scale, states, layout)
        for name, plane, scale in zip(names, planes, packed.scales, strict=True)
    }
    bounds = {name: 0.5 * scale for name, scale in zip(names, packed.scales, strict=True)}
    return DecodedChannel(packed.run, packed.index, packed.time, packed.channel, fields, bounds)


def _field(
    name: str, numbers: UInt16Array, scale: float, states: UInt8Array, layout: BlockLayout
) -> FloatArray:
    values = numbers.view(np.int16) if name in SIGNED else numbers
    field = np.zeros((layout.nrows, layout.ncols), np.float32)
    decoded = values.astype(np.float32) * np.float32(scale)
    if name in TIMES:
        field += np.float32(np.inf)
        decoded[numbers == NEVER] = np.inf
    layout.scatter(decoded, states, field)
    return field
