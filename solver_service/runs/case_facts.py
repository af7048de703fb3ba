"""What the run tree keeps of a case, so that runs can be listed and replayed without loading it."""

from __future__ import annotations

import msgspec

from protocol import ForcingItem, GaugePlace, GridInfo, Layer, SectionPlace


class CaseFacts(msgspec.Struct, frozen=True):
    """Facts of a case that do not change during its runs.

    Attributes:
        grid: the grid.
        hypothetical: whether the event never happened.
        depth_wet: depth below which a cell is sent as dry [m].
        source: where the data comes from.
        licence: licence of the data.
        start_time: clock time of frame 0, ISO 8601 with offset.
        forcing: what drives it from outside.
        layers: pictures of its terrain.
        gauges: where its gauges are.
        sections: where its sections are.
    """

    grid: GridInfo
    hypothetical: bool
    depth_wet: float
    source: str = ""
    licence: str = ""
    start_time: str | None = None
    forcing: tuple[ForcingItem, ...] = ()
    layers: tuple[Layer, ...] = ()
    gauges: tuple[GaugePlace, ...] = ()
    sections: tuple[SectionPlace, ...] = ()

    def pack(self) -> bytes:
        """The stored form."""
        return msgspec.msgpack.encode(self)

    @staticmethod
    def unpack(packed: bytes) -> CaseFacts:
        """Read the stored form."""
        return msgspec.msgpack.decode(packed, type=CaseFacts)
