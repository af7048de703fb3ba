"""Series of gauges and sections to bytes and back."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from protocol.depth_codec import FloatArray
from protocol.errors import FrameError
from protocol.messages import Series

RealArray = npt.NDArray[np.float64]


@dataclass(frozen=True)
class DecodedSeries:
    """Records of gauges and sections.

    Attributes:
        run: id of the run that holds the last frame.
        index: last frame index that the records belong to.
        times: times [s], [record], rising.
        gauges: ids of the gauges.
        gauge_values: depth [m], level [m, relative to the datum offset], velocity to the east and north
            [m/s], float32 [record, gauge, 4].
        sections: ids of the sections.
        section_values: discharge [m3/s], volume since the start [m3], wet area [m2], [record, section, 3].
    """

    run: str
    index: int
    times: RealArray
    gauges: tuple[str, ...]
    gauge_values: FloatArray
    sections: tuple[str, ...]
    section_values: RealArray


def encode_series(series: DecodedSeries) -> Series:
    """The message of some records."""
    return Series(
        run=series.run,
        index=series.index,
        times=series.times.astype("<f8").tobytes(),
        gauges=series.gauges,
        gauge_values=series.gauge_values.astype("<f4").tobytes(),
        sections=series.sections,
        section_values=series.section_values.astype("<f8").tobytes(),
    )


def decode_series(series: Series) -> DecodedSeries:
    """The records of a message.

    Raises:
        FrameError: when the sizes do not fit each other, a number is not finite or the times do not rise.
    """
    count = len(series.times) // 8
    wanted = (8 * count, 16 * count * len(series.gauges), 24 * count * len(series.sections))
    found = (len(series.times), len(series.gauge_values), len(series.section_values))
    if found != wanted:
        raise FrameError(f"Series of run {series.run!r} have {found} bytes; {wanted} are allowed.")
    times = np.frombuffer(series.times, "<f8").astype(np.float64)
    gauges = np.frombuffer(series.gauge_values, "<f4").astype(np.float32)
    sections = np.frombuffer(series.section_values, "<f8").astype(np.float64)
    if not all(np.isfinite(values).all() for values in (times, gauges, sections)):
        raise FrameError(f"Series of run {series.run!r} hold numbers that are not finite.")
    if (np.diff(times) <= 0.0).any():
        raise FrameError(f"The times of the series of run {series.run!r} do not rise.")
    return DecodedSeries(
        series.run,
        series.index,
        times,
        series.gauges,
        gauges.reshape(count, len(series.gauges), 4),
        series.sections,
        sections.reshape(count, len(series.sections), 3),
    )


def join_series(pieces: Sequence[Series]) -> Series:
    """The records of several messages, in order of time, as one.

    Raises:
        FrameError: when they are of different gauges or sections.
    """
    last = pieces[-1]
    for piece in pieces:
        if (piece.gauges, piece.sections) != (last.gauges, last.sections):
            raise FrameError(f"Series of runs {piece.run!r} and {last.run!r} have different places.")
    return Series(
        run=last.run,
        index=last.index,
        times=b"".join(piece.times for piece in pieces),
        gauges=last.gauges,
        gauge_values=b"".join(piece.gauge_values for piece in pieces),
        sections=last.sections,
        section_values=b"".join(piece.section_values for piece in pieces),
    )
