"""Gauges and sections of the shown run: their marks on the picture, and the one whose series is on show."""

from __future__ import annotations

import dataclasses
import math
from itertools import pairwise

import protocol
from viewer.app.camera_work import CameraWork
from viewer.app.flow_probe import Record
from viewer.app.pointing import Pointing
from viewer.app.run_book import RunBook
from viewer.app.series_feed import NOTHING, SeriesFeed
from viewer.app.shown_run import ShownRun
from viewer.commands import CommandError, ProbeAt, ShowSeries
from viewer.render import DrapedLine, FrameInputs, LineStyle, PlaceMark, RenderOptions
from viewer.view_status import PlaceRow, ViewStatus
from viewer.world import Point

__all__ = ["Gauges"]

MOST_MARKS = 64
"""With more gauges and sections than this only the chosen one is marked: names would cover the picture."""
CLICK_SIDE, CLICK_BELOW, CLICK_ABOVE = 0.03, 0.015, 0.06
"""How far beside, below and above the foot of a mark a click may be, as shares of the picture's height."""
LINE_CELLS = 0.3


class Gauges:
    """Knows where gauges and sections are and which of them is chosen.

    Args:
        book: holds what the service told of the places of each run.
        series: fetches records.
        pointing: reads depth and ground at a place.

    Attributes:
        chosen: the gauge or section whose series is on show, None for none.
    """

    def __init__(self, book: RunBook, series: SeriesFeed, pointing: Pointing) -> None:
        self._book = book
        self._series = series
        self._pointing = pointing
        self.chosen: PlaceRow | None = None

    def take(
        self,
        command: ProbeAt | ShowSeries,
        shown: ShownRun | None,
        work: CameraWork | None,
        options: RenderOptions,
    ) -> bool:
        """Choose a gauge or section by name or by a click at its mark; a click elsewhere probes the point.

        Returns:
            whether another one is chosen now.

        Raises:
            CommandError: the shown run has none of that name.
        """
        before = self.chosen
        if isinstance(command, ShowSeries):
            self.chosen = self._named(command, shown)
        else:
            self.chosen = None
            if shown is not None and work is not None and options.show_gauges:
                self.chosen = self._clicked(command, shown, work, options)
            if self.chosen is None:
                self._pointing.take(command, shown)
        if self.chosen is not None:
            self._pointing.probe_at = None  # nothing more is to be read there
        return self.chosen != before

    def advance(self, shown: ShownRun, other: ShownRun | None, now: float) -> None:
        """Let series come while one is on show.

        Args:
            shown: the run on the picture.
            other: the run that it is compared with.
            now: wall time [s, monotonic].
        """
        if self.chosen is not None and self.chosen not in self._rows(shown):
            self.chosen = None  # another case
        if self.chosen is not None:
            self._series.follow((shown,) if other is None else (shown, other), now)

    def dressed(self, inputs: FrameInputs, shown: ShownRun) -> FrameInputs:
        """Return the inputs of a picture with the marks."""
        if not inputs.options.show_gauges:
            return inputs
        places = self._places(shown)
        marked = [at for at in places if len(places) <= MOST_MARKS or at[0] == self.chosen]
        marks = tuple(
            PlaceMark(row.id, self._point(shown, *at, inputs.options.exaggeration), row == self.chosen)
            for row, at in marked
        )
        rows = {row for row, _ in marked}
        lines = tuple(
            DrapedLine(section.line, LINE_CELLS * shown.grid.dx, LineStyle.SECTION)
            for section in self._told(shown).sections
            if PlaceRow(section.id, "section") in rows
        )
        return dataclasses.replace(inputs, marks=marks, lines=lines)

    def report(self, status: ViewStatus, shown: ShownRun, other: ShownRun | None) -> ViewStatus:
        """Return `status` with the places and the records of the chosen one."""
        status = dataclasses.replace(status, places=tuple(self._rows(shown)), series_of=self.chosen)
        if self.chosen is None:
            return status
        name = self.chosen.id

        def both(kind: str) -> tuple[Record, Record]:
            ours = self._series.record(shown.run, name, kind)
            return ours, NOTHING if other is None else self._series.record(other.run, name, kind)

        if self.chosen.kind == "section":
            ours, theirs = both("discharge")
            return dataclasses.replace(
                status,
                probe=None,
                depth_record=NOTHING,
                speed_record=NOTHING,
                other_depth_record=NOTHING,
                other_speed_record=NOTHING,
                discharge_record=ours,
                other_discharge_record=theirs,
            )
        at = dict(self._places(shown))[self.chosen]
        (depth, other_depth), (speed, other_speed) = both("depth"), both("speed")
        return dataclasses.replace(
            status,
            probe=self._pointing.readout(*at, shown),
            depth_record=depth,
            speed_record=speed,
            other_depth_record=other_depth,
            other_speed_record=other_speed,
        )

    def _named(self, command: ShowSeries, shown: ShownRun | None) -> PlaceRow | None:
        if command.id is None:
            return None
        known = self._rows(shown)
        found = [row for row in known if row.id == command.id and command.kind in ("", row.kind)]
        if not found:
            names = ", ".join(repr(row.id) for row in known) or "none"
            raise CommandError(f"ShowSeries.id = {command.id!r} is no gauge or section; known are {names}")
        return found[0]

    def _clicked(
        self, at: ProbeAt, shown: ShownRun, work: CameraWork, options: RenderOptions
    ) -> PlaceRow | None:
        places = self._places(shown)
        clicked = work.camera.seen_at(self._point(shown, at.x, at.y, options.exaggeration), work.aspect)
        if clicked is None or len(places) > MOST_MARKS:
            return None
        for row, place in places:
            seen = work.camera.seen_at(self._point(shown, *place, options.exaggeration), work.aspect)
            if seen is None:
                continue
            beside, above = 0.5 * work.aspect * abs(clicked[0] - seen[0]), 0.5 * (clicked[1] - seen[1])
            if beside <= CLICK_SIDE and -CLICK_BELOW <= above <= CLICK_ABOVE:
                return row
        return None

    def _told(self, shown: ShownRun) -> protocol.Places:
        told = (self._book.places.get(entry.run) for entry in reversed(shown.lineage))
        return next((places for places in told if places is not None), protocol.Places(shown.run))

    def _places(self, shown: ShownRun) -> list[tuple[PlaceRow, tuple[float, float]]]:
        """Gauges, and sections by the middle of their lines [m]."""
        told = self._told(shown)
        found = [(PlaceRow(gauge.id, "gauge"), (gauge.x, gauge.y)) for gauge in told.gauges]
        return found + [(PlaceRow(at.id, "section"), _middle(at.line)) for at in told.sections]

    def _rows(self, shown: ShownRun | None) -> list[PlaceRow]:
        return [] if shown is None else [row for row, _ in self._places(shown)]

    def _point(self, shown: ShownRun, x: float, y: float, exaggeration: float) -> Point:
        """The world point of a place, on the water where there is some."""
        field = shown.heightfield
        reading = self._pointing.readout(x, y, shown)
        depth = 0.0 if reading is None or reading.depth is None else reading.depth
        return field.frame.exaggerated(exaggeration).to_world(x, y, float(field.sample(x, y)) + depth)


def _middle(line: tuple[tuple[float, float], ...]) -> tuple[float, float]:
    """The point of a line from which it is as far to both ends, along it."""
    left = 0.5 * sum(math.dist(start, end) for start, end in pairwise(line))
    for start, end in pairwise(line):
        length = math.dist(start, end)
        if length > 0.0 and left <= length:
            share = left / length
            return start[0] + share * (end[0] - start[0]), start[1] + share * (end[1] - start[1])
        left -= length
    return line[-1]
