"""One series up to a time, another one from then on: what drives a run whose forcing was changed.

The joined series gives the same integral up to the join as the first one, so that what a run has booked of
its inflows stays true. A linear series jumps there within the shortest time that a float can tell.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt


class SeriesArrays(NamedTuple):
    """Rising times [s], [k], and values, [k, ...]."""

    times: npt.NDArray[np.float64]
    values: npt.NDArray[np.float64]


def join_series(
    before: SeriesArrays, after: SeriesArrays, time: float, stepped: bool, holds_first: bool
) -> SeriesArrays:
    """The series that is `before` up to a time and `after` from then on.

    Args:
        before: the first series.
        after: the second one, with values of the same shape.
        time: where they join [s], above 0.
        stepped: whether a value holds until the next time; else they are linear between.
        holds_first: whether the first value holds before the first time too; else it is 0 there.

    Returns:
        The joined series.
    """
    kept, coming = before.times < time, after.times > time
    soon = float(np.nextafter(time, np.inf))
    pieces = [SeriesArrays(before.times[kept], before.values[kept])]
    if stepped:
        pieces.append(_entry(time, value_at(after, time, stepped, holds_first)))
    else:
        pieces.append(_entry(time, value_at(before, time, stepped, holds_first)))
        pieces.append(_entry(soon, value_at(after, soon, stepped, holds_first)))
        coming = after.times > soon
        first = float(after.times[0])
        just_before = float(np.nextafter(first, -np.inf))
        if not holds_first and just_before > soon:
            pieces.append(_entry(just_before, np.zeros_like(after.values[0])))
    pieces.append(SeriesArrays(after.times[coming], after.values[coming]))
    return SeriesArrays(
        np.concatenate([piece.times for piece in pieces]), np.concatenate([piece.values for piece in pieces])
    )


def value_at(series: SeriesArrays, time: float, stepped: bool, holds_first: bool) -> npt.NDArray[np.float64]:
    """Value of a series at a time [s]; see `join_series`."""
    times, values = series
    last = int(np.searchsorted(times, time, side="right")) - 1
    if last < 0:
        return values[0] if holds_first else np.zeros_like(values[0])
    if stepped or last + 1 == times.size:
        found: npt.NDArray[np.float64] = values[last]
        return found
    part = (time - times[last]) / (times[last + 1] - times[last])
    between: npt.NDArray[np.float64] = values[last] + part * (values[last + 1] - values[last])
    return between


def _entry(time: float, value: npt.NDArray[np.float64]) -> SeriesArrays:
    return SeriesArrays(np.array([time]), np.asarray(value, np.float64)[None])
