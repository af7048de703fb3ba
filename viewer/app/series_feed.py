"""Fetches what gauges and sections have recorded, stretch by stretch while a run computes."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

import protocol
from viewer.app.flow_probe import Record
from viewer.app.service_desk import ServiceDesk
from viewer.app.shown_run import ShownRun

__all__ = ["SeriesFeed"]

PAUSE_S = 0.5
"""Least wall time between two requests for a run."""
LOST_AFTER_S = 20.0
"""Wall time after which a request counts as lost, say with its connection."""
REFUSED_PAUSE_S = 5.0
"""Further wall time before what was refused is asked for again."""
NOTHING: Record = ((), ())


@dataclass
class _RunSeries:
    next_index: int = 0
    known: protocol.DecodedSeries | None = None
    asked: float = -math.inf
    number: int | None = None
    is_broken: bool = False


class SeriesFeed:
    """Keeps the series of the runs that are followed.

    Args:
        desk: the dealings with the service.
        complain: shows a sentence to the user.
    """

    def __init__(self, desk: ServiceDesk, complain: Callable[[str], None]) -> None:
        self._desk = desk
        self._complain = complain
        self._runs: dict[str, _RunSeries] = {}
        self._records: dict[tuple[str, str, str], Record] = {}
        desk.series_came = self._take

    def follow(self, runs: tuple[ShownRun, ...], now: float) -> None:
        """Ask for what these runs have recorded since it was asked for last; forget all other runs.

        Args:
            runs: whose series are on show.
            now: wall time [s, monotonic].
        """
        names = {run.run for run in runs}
        self._runs = {name: self._runs.get(name, _RunSeries()) for name in names}
        self._records = {key: record for key, record in self._records.items() if key[0] in names}
        for name, series in self._runs.items():
            info = self._desk.book.runs.get(name)
            pause = PAUSE_S if series.number is None else LOST_AFTER_S
            if info is None or series.is_broken or now - series.asked < pause or not self._desk.is_open:
                continue
            if series.next_index < info.frame_count:
                series.asked = now
                self._ask(name, series)

    def record(self, run: str, name: str, kind: str) -> Record:
        """Return times [s] and values of a run, as far as they have come; the same object until more come.

        Args:
            run: id of the run.
            name: id of the gauge or section.
            kind: "depth" [m] or "speed" [m/s] of a gauge, "discharge" [m3/s] of a section.
        """
        series = self._runs.get(run)
        if series is None or series.known is None:
            return NOTHING
        key = (run, name, kind)
        if key not in self._records:
            self._records[key] = _record(series.known, name, kind)
        return self._records[key]

    def _ask(self, run: str, series: _RunSeries) -> None:
        def numbered(number: int) -> None:
            series.number = number

        def refused(_reason: str) -> None:
            series.number = None
            series.asked += REFUSED_PAUSE_S

        self._desk.fetch_series(run, series.next_index, numbered, refused)

    def _take(self, message: protocol.SeriesReceived) -> None:
        for run, series in self._runs.items():
            if series.number == message.id:
                series.number = None
                try:
                    series.known = _joined(series.known, protocol.decode_series(message.series))
                except protocol.FrameError as error:
                    series.is_broken = True
                    self._complain(f"the series of run {run} cannot be read: {error}")
                    return
                series.next_index = message.series.index + 1
                self._records = {key: record for key, record in self._records.items() if key[0] != run}
                return


def _joined(known: protocol.DecodedSeries | None, more: protocol.DecodedSeries) -> protocol.DecodedSeries:
    if known is None:
        return more
    if (known.gauges, known.sections) != (more.gauges, more.sections):
        raise protocol.FrameError("its gauges or sections have changed.")
    return protocol.DecodedSeries(
        more.run,
        more.index,
        np.concatenate([known.times, more.times]),
        more.gauges,
        np.concatenate([known.gauge_values, more.gauge_values]),
        more.sections,
        np.concatenate([known.section_values, more.section_values]),
    )


def _record(series: protocol.DecodedSeries, name: str, kind: str) -> Record:
    names = series.sections if kind == "discharge" else series.gauges
    if name not in names:
        return NOTHING
    place = names.index(name)
    if kind == "discharge":
        values = series.section_values[:, place, 0]
    elif kind == "depth":
        values = series.gauge_values[:, place, 0].astype(np.float64)
    else:
        values = np.hypot(series.gauge_values[:, place, 2], series.gauge_values[:, place, 3])
    return tuple(series.times.tolist()), tuple(values.tolist())
