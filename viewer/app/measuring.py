"""The measuring tool: a line of points on the ground, its length and the area within it."""

from __future__ import annotations

import dataclasses

from viewer.app.shown_run import ShownRun
from viewer.commands import AddMeasurePoint, BeginMeasure, Command, CommandError, EndMeasure
from viewer.render import DrapedLine, EditOverlay, LineStyle
from viewer.units import Units
from viewer.view_status import ViewStatus
from viewer.world import Measure, measure

__all__ = ["Measuring"]

MOST_POINTS = 1000
WIDTH_CELLS = 0.3


class Measuring:
    """What is being measured.

    Attributes:
        is_on: whether the tool is in the hand.
        points: the points set so far (x, y) [m].
        hover: where the pointer is, the end of the rubber band; None: nowhere.
    """

    def __init__(self) -> None:
        self.is_on = False
        self.points: list[tuple[float, float]] = []
        self.hover: tuple[float, float] | None = None

    def carry_out(self, command: Command, shown: ShownRun | None) -> bool:
        """Carry out a command of the tool; return False when it is none.

        Raises:
            CommandError: there is no terrain, the tool is not on, or the point lies outside the terrain.
        """
        match command:
            case BeginMeasure():
                if shown is None:
                    raise CommandError("no run is shown yet")
                self.put_away()
                self.is_on = True
            case AddMeasurePoint(x, y):
                self._add(x, y, shown)
            case EndMeasure():
                self.put_away()
            case _:
                return False
        return True

    def put_away(self) -> None:
        """Drop the line and the tool."""
        self.is_on, self.points, self.hover = False, [], None

    def text(self, shown: ShownRun, units: Units) -> str:
        """Return what is measured in words, empty before there are two points."""
        points = self._with_hover()
        if len(points) < 2:
            return ""
        return _words(measure(points, shown.heightfield), units)

    def overlay(self, marks: EditOverlay | None, shown: ShownRun) -> EditOverlay | None:
        """Return the marks on the ground with the line, closed once there is an area."""
        points = self._with_hover()
        if len(points) < 2:
            return marks
        path = tuple(points) if len(points) < 3 else (*points, points[0])
        line = DrapedLine(path, WIDTH_CELLS * shown.grid.dx, LineStyle.MEASURE)
        if marks is None:
            preview = shown.document.preview()
            return EditOverlay(shown.overlay_revision(), preview.sign, (line,))
        return dataclasses.replace(marks, lines=(*marks.lines, line))

    def report(self, status: ViewStatus, shown: ShownRun) -> ViewStatus:
        """Return `status` with what is measured, in its units."""
        told = self.text(shown, status.units)
        return dataclasses.replace(status, is_measuring=self.is_on, measured=told)

    def _add(self, x: float, y: float, shown: ShownRun | None) -> None:
        if not self.is_on or shown is None:
            raise CommandError("AddMeasurePoint needs the measuring tool: BeginMeasure first")
        if not shown.grid.contains(x, y):
            raise CommandError(f"the point ({x:g}, {y:g}) lies outside of the terrain")
        if len(self.points) == MOST_POINTS:
            raise CommandError(f"{MOST_POINTS} points are measured already")
        if not self.points or self.points[-1] != (x, y):  # the second press of a double click
            self.points.append((x, y))

    def _with_hover(self) -> list[tuple[float, float]]:
        return [*self.points, self.hover] if self.points and self.hover is not None else self.points


def _words(made: Measure, units: Units) -> str:
    length, ground = units.distance_text(made.length), units.distance_text(made.ground_length)
    told = f"{length}, {ground} over the ground, {units.shown(made.rise):+,.1f} {units.length}"
    if made.area > 0.0:
        told += f"; within it {units.area_text(made.area)}"
    return told
