"""Frames: the water of one output time. The packed bytes are stored and sent unchanged."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from msgspec import Meta

from protocol.fields import (
    FrameIndex,
    Identifier,
    Message,
    NotNegative,
    PartCount,
    PartNumber,
    Positive,
    RawSize,
    Revision,
)
from protocol.limits import MAX_BED_CELLS, MAX_FRAME_BYTES, MAX_STATE_BYTES, PART_BYTES

FrameCodec = Literal["u2", "planes"]


class Frame(Message, frozen=True):
    """Water depth of one output time. The page on the protocol says how the payload is laid out.

    Attributes:
        run: id of the run that holds the frame (an ancestor's id for the shared past).
        index: frame index.
        time: simulated time [s].
        revision: revision of the edits in the bed.
        key_index: frame index of the key frame; equal to index for a key frame itself.
        scale: depth of one unit [m].
        states: block states, two bits a block.
        raw_size: bytes of the payload when unpacked.
        checksum: CRC-32 of the numbers of the payload, of bed_cells and of bed_values, one after the other.
        payload: depths of the cells owned by blocks that are not dry, compressed.
        bed_cells: cells whose bed is not base and edits at that time, since breaches have lowered them.
        bed_values: their bed [m, relative to the datum offset].
        codec: how the numbers of the payload are laid out.
    """

    left_out: ClassVar[tuple[str, ...]] = ("bed_cells", "bed_values", "codec")

    run: Identifier
    index: FrameIndex
    time: NotNegative
    revision: Revision
    key_index: FrameIndex
    scale: Positive
    states: Annotated[bytes, Meta(max_length=MAX_STATE_BYTES)]
    raw_size: RawSize
    checksum: Annotated[int, Meta(ge=0, le=0xFFFFFFFF)]
    payload: Annotated[bytes, Meta(max_length=MAX_FRAME_BYTES)]
    bed_cells: Annotated[bytes, Meta(max_length=4 * MAX_BED_CELLS)] = b""
    bed_values: Annotated[bytes, Meta(max_length=4 * MAX_BED_CELLS)] = b""
    codec: FrameCodec = "u2"

    @property
    def is_key(self) -> bool:
        """Whether the frame stands alone."""
        return self.key_index == self.index


class FramePart(Message, frozen=True):
    """A piece of a packed `frame` that is larger than `PART_BYTES`; the pieces in order are its bytes.

    Attributes:
        run: id of the run that holds the frame.
        index: frame index.
        part: number of this part, from 0.
        parts: number of parts.
        data: bytes of this part.
    """

    run: Identifier
    index: FrameIndex
    part: PartNumber
    parts: PartCount
    data: Annotated[bytes, Meta(max_length=PART_BYTES)]
