"""The base bed of a run, lossless, in parts."""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta

from protocol.fields import Command, CommandId, Identifier, Message, PartCount, PartNumber, Side
from protocol.limits import PART_BYTES


class GetTerrain(Command, frozen=True):
    """Ask for the base bed of a run; after the `ack` come the `terrain` parts.

    Attributes:
        run: id of the run.
    """

    run: Identifier


class Terrain(Message, frozen=True):
    """One part of the base bed, before any edit.

    All parts' data in order are one zstd frame of nrows x ncols little-endian float32: elevation [m] relative
    to the grid's datum_offset, row 0 south.

    Attributes:
        id: id of the command.
        run: id of the run.
        part: number of this part, from 0.
        parts: number of parts.
        shape: rows and columns.
        codec: "zstd-f32".
        data: bytes of this part.
    """

    id: CommandId
    run: Identifier
    part: PartNumber
    parts: PartCount
    shape: tuple[Side, Side]
    codec: Literal["zstd-f32"]
    data: Annotated[bytes, Meta(max_length=PART_BYTES)]
