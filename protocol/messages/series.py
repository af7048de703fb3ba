"""Series: what gauges and sections have recorded, at the full rate of the solver."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from protocol.fields import Command, FrameIndex, Identifier, Message, Name
from protocol.limits import MAX_SERIES_BYTES, MAX_SERIES_PLACES

Names = Annotated[tuple[Name, ...], Meta(max_length=MAX_SERIES_PLACES)]
Numbers = Annotated[bytes, Meta(max_length=MAX_SERIES_BYTES)]


class GetSeries(Command, frozen=True):
    """Ask for what gauges and sections have recorded; after the `ack` come the `channel_part` messages.

    The `ack` has result.index, the last frame index that the answer reaches; ask again from the next one to
    go on. Refused where the case has neither gauges nor sections or the frame is not computed.

    Attributes:
        run: id of the run.
        from_index: first frame index wanted; a frame brings the records after the frame before it, up to its
            own time. Those of the shared past are the ancestor's.
    """

    run: Identifier
    from_index: FrameIndex = 0


class Series(Message, frozen=True):
    """Records of gauges and sections; sent as the data of `channel_part`.

    All numbers are little-endian; of n records, g gauges and s sections.

    Attributes:
        run: id of the run that holds the last of these frames.
        index: last frame index that the records belong to.
        times: times of the records [s], n float64, rising.
        gauges: ids of the gauges.
        gauge_values: n x g x 4 float32: depth [m], level [m, relative to the datum offset; the bed where it
            is dry], velocity to the east and north [m/s].
        sections: ids of the sections.
        section_values: n x s x 3 float64: discharge [m3/s, positive to the right of the line], volume passed
            since the start [m3], wet area [m2].
    """

    run: Identifier
    index: FrameIndex
    times: Numbers
    gauges: Names
    gauge_values: Numbers
    sections: Names
    section_values: Numbers
