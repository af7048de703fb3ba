"""A frame as the device gives it, on its way to the store, and the packing of what goes with its depth."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from protocol import BlockLayout, ChannelName, DecodedSeries, encode_channel, encode_series, pack
from solver_service.numerics.fields import NEVER
from solver_service.runs.frame_series import SERIES


@dataclass(frozen=True)
class QuantisedFrame:
    """The water of one output time as the device gives it.

    Attributes:
        run: the run.
        index: frame index.
        time: simulated time [s].
        revision: revision of the edits in the bed.
        q: quantised depth, uint16 [nrows, ncols].
        states: block states, uint8 [block_rows, block_cols].
        scale: depth of one unit [m].
        bed: cells that breaches have lowered, as row x ncols + col, rising, and their bed [m].
        channels: the channels that go with it, each with its fields by name, as the solver has them.
        series: the records of gauges and sections that belong to it; None where there are none.
        depth_wet: depth from which a cell counts as wet [m].
    """

    run: str
    index: int
    time: float
    revision: int
    q: NDArray[np.uint16]
    states: NDArray[np.uint8]
    scale: float
    bed: tuple[NDArray[np.int64], NDArray[np.float32]] | None = None
    channels: Mapping[ChannelName, Mapping[str, NDArray[np.float32]]] = field(default_factory=dict)
    series: DecodedSeries | None = None
    depth_wet: float = 1e-3

    @property
    def nbytes(self) -> int:
        """Memory of its rasters."""
        rasters = (raster for fields in self.channels.values() for raster in fields.values())
        return self.q.nbytes + sum(raster.nbytes for raster in rasters)


def pack_channels(frame: QuantisedFrame, layout: BlockLayout) -> dict[str, bytes]:
    """The packed channels and series of a frame, by name; changes the rasters of its channels."""
    packed: dict[str, bytes] = {}
    if frame.series is not None:
        packed[SERIES] = pack(encode_series(frame.series))
    for name, fields in frame.channels.items():
        if name == "velocity":
            reached, states = frame.q > 0, frame.states
        else:
            arrival = fields["arrival_time"]
            came = arrival < np.float32(NEVER)
            arrival[~came] = np.inf
            reached = came | (fields["max_depth"] >= np.float32(frame.depth_wet))
            states = layout.classify(reached.astype(np.uint16))
        for field_name, values in fields.items():
            if field_name != "arrival_time":
                values *= reached
        packed[name] = encode_channel(layout, frame.run, frame.index, frame.time, name, fields, states)
    return packed
