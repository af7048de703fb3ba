"""Pictures that belong to the terrain of a run: what it looks like from above, and where it has no data."""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta

from protocol.fields import Command, CommandId, Identifier, Message, PartCount, PartNumber
from protocol.limits import PART_BYTES

Layer = Literal["imagery", "walls"]
Layers = Annotated[tuple[Layer, ...], Meta(max_length=2)]


class GetImagery(Command, frozen=True):
    """Ask for a picture of the terrain; after the `ack` come the `imagery_part` messages.

    Refused where the run has no such picture; `layers` of the run names those there are.

    Attributes:
        run: id of the run.
        layer: "imagery" is a colour picture of the ground, "walls" shows the cells without data.
    """

    run: Identifier
    layer: Layer = "imagery"


class ImageryPart(Message, frozen=True):
    """One part of a picture, north side up, that covers the extent of the grid.

    The data of all parts in order are one file: for "imagery" a JPEG of three colours with at most
    MAX_IMAGERY_SIDE pixels along a side, for "walls" a greyscale PNG with one pixel a cell, 255 where there
    is no data and 0 elsewhere.

    Attributes:
        id: id of the command.
        run: id of the run.
        layer: which picture.
        part: number of this part, from 0.
        parts: number of parts.
        data: bytes of this part.
    """

    id: CommandId
    run: Identifier
    layer: Layer
    part: PartNumber
    parts: PartCount
    data: Annotated[bytes, Meta(max_length=PART_BYTES)]
