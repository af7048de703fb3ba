"""Places that a run watches: where its gauges and sections are."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from protocol.fields import Coordinate, Identifier, Message, Name, WireStruct
from protocol.limits import MAX_PLACE_POINTS, MAX_PLACES

Vertex = tuple[Coordinate, Coordinate]


class GaugePlace(WireStruct, frozen=True):
    """Where a gauge is.

    Attributes:
        id: its name, as in `Series`.
        x: x [m].
        y: y [m].
    """

    id: Name
    x: Coordinate
    y: Coordinate


class SectionPlace(WireStruct, frozen=True):
    """Where a section is.

    Attributes:
        id: its name, as in `Series`.
        line: (x, y) of its vertices [m]; longer lines are thinned.
    """

    id: Name
    line: Annotated[tuple[Vertex, ...], Meta(min_length=2, max_length=MAX_PLACE_POINTS)]


class Places(Message, frozen=True):
    """What a run records series of; comes with the subscription where its case has gauges or sections.

    Attributes:
        run: id of the run.
        gauges: its gauges, in the order of the case; of many the first.
        sections: its sections, likewise.
    """

    run: Identifier
    gauges: Annotated[tuple[GaugePlace, ...], Meta(max_length=MAX_PLACES)] = ()
    sections: Annotated[tuple[SectionPlace, ...], Meta(max_length=MAX_PLACES)] = ()
