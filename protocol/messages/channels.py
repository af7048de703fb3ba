"""Channels: what a run keeps of a frame beside its depth, asked for one frame at a time."""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta

from protocol.fields import (
    Command,
    CommandId,
    FrameIndex,
    Identifier,
    Message,
    NotNegative,
    PartCount,
    PartNumber,
    Positive,
)
from protocol.limits import MAX_CHANNEL_BYTES, MAX_STATE_BYTES, PART_BYTES

ChannelName = Literal["velocity", "maxima"]


class GetChannel(Command, frozen=True):
    """Ask for a channel of a frame; after the `ack` come the `channel_part` messages.

    Refused where the run keeps no such channel or the frame is not computed. Maxima are kept with some frames
    only: the newest at or before the index are sent, and the channel says of which frame they are.

    Attributes:
        run: id of the run.
        index: frame index; one of the shared past is that of the ancestor.
        channel: name of the channel.
    """

    run: Identifier
    index: FrameIndex
    channel: ChannelName


class Channel(Message, frozen=True):
    """A packed channel of one frame: stored as these bytes, and sent as the data of `channel_part`.

    Attributes:
        run: id of the run that holds the frame (an ancestor's id for the shared past).
        index: frame index.
        time: simulated time [s].
        channel: name of the channel.
        states: block states, two bits a block: of the frame for velocity, of all water since the start for
            maxima.
        scales: what one unit of each field is, in the order of the fields.
        raw_size: bytes of the payload when unpacked.
        checksum: CRC-32 of the unpacked payload.
        payload: the fields of the cells owned by blocks that are not dry, one after the other, compressed.
    """

    run: Identifier
    index: FrameIndex
    time: NotNegative
    channel: ChannelName
    states: Annotated[bytes, Meta(max_length=MAX_STATE_BYTES)]
    scales: Annotated[tuple[Positive, ...], Meta(max_length=8)]
    raw_size: Annotated[int, Meta(ge=0, le=MAX_CHANNEL_BYTES)]
    checksum: Annotated[int, Meta(ge=0, le=0xFFFFFFFF)]
    payload: Annotated[bytes, Meta(max_length=MAX_CHANNEL_BYTES)]


class ChannelPart(Message, frozen=True):
    """One part of a packed channel or series; the data of all parts in order are the bytes of that message.

    Attributes:
        id: id of the `get_channel` or `get_series` command.
        part: number of this part, from 0.
        parts: number of parts.
        data: bytes of this part.
    """

    id: CommandId
    part: PartNumber
    parts: PartCount
    data: Annotated[bytes, Meta(max_length=PART_BYTES)]
