"""Depth and speed against time at the point clicked last or at a gauge, or what passes a section."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QComboBox, QLabel, QSizePolicy, QVBoxLayout, QWidget

from viewer.commands import ShowSeries
from viewer.gui.conductor import Dispatch
from viewer.gui.status_line import readout_text
from viewer.gui.theme import ACCENT, BRANCH
from viewer.units import Units
from viewer.view_status import PlaceRow, ViewStatus

__all__ = ["DepthPlot", "RecordPlot"]

OTHER = (232, 148, 204)
"""Colour of the run that is compared with."""
LEAST_HIGH = 0.1
"""The axis reaches at least so far, in the unit shown: dry ground is a line at its foot."""
Record = tuple[tuple[float, ...], tuple[float, ...]]
POINT = "Clicked point"


class RecordPlot(pg.PlotWidget):
    """One quantity against time; the vertical line is the time shown.

    Args:
        name: the quantity.
        convert: from SI to the units shown.

    Attributes:
        curve: the shown run.
        other: the run that it is compared with, dashed.
        now: the time shown.
    """

    def __init__(self, name: str, convert: Callable[[Units, Any], Any] = Units.shown) -> None:
        super().__init__(background=None)
        self._convert = convert
        self.setAccessibleName(f"{name.capitalize()} over time at the chosen place")
        self.setMinimumHeight(84)
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Ignored)
        self.setMenuEnabled(False)
        self.setMouseEnabled(False, False)
        self.hideButtons()
        self.setLabel("bottom", "time [min]")
        self.getAxis("left").enableAutoSIPrefix(False)
        self.showGrid(x=True, y=True, alpha=0.15)
        self.curve = self.plot(pen=pg.mkPen(ACCENT, width=2), fillLevel=0.0, brush=(61, 155, 224, 60))
        self.other = self.plot(pen=pg.mkPen(OTHER, width=2, style=Qt.PenStyle.DashLine))
        self.now = pg.InfiniteLine(angle=90, pen=pg.mkPen(BRANCH, width=1))
        self.addItem(self.now)
        self._shown: tuple[Record, Record, str] = (((), ()), ((), ()), "")

    def show_records(self, ours: Record, theirs: Record, status: ViewStatus) -> None:
        """Draw the records of both runs, in SI and s, in the units of a status and with its time."""
        units = status.units
        self.now.setPos(status.time / 60.0)
        if status.duration > 0.0:
            self.setXRange(0.0, status.duration / 60.0, padding=0.02)
        if (ours, theirs, units.name) == self._shown:
            return
        self._shown = (ours, theirs, units.name)
        low, high = 0.0, LEAST_HIGH
        for curve, (times, values) in ((self.curve, ours), (self.other, theirs)):
            drawn = self._convert(units, np.asarray(values, dtype=np.float64))
            curve.setData(np.asarray(times, dtype=np.float64) / 60.0, drawn)
            low, high = min(low, drawn.min(initial=0.0)), max(high, drawn.max(initial=0.0))
        self.setYRange(low, high, padding=0.05)


class DepthPlot(QWidget):
    """The dock of the clicked point, or of a gauge or section: what is there, and its records over time.

    Attributes:
        places: chooses a gauge or section; hidden where the case has none.
    """

    def __init__(self, dispatch: Dispatch, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._dispatch = dispatch
        self._rows: tuple[PlaceRow, ...] = ()
        self.places = QComboBox()
        self.places.setAccessibleName("Place of the plots")
        self.places.setToolTip("The clicked point, or a gauge or section of the case at full rate")
        self.places.activated.connect(self._choose)
        self.places.hide()
        self.caption = QLabel("Click the ground to see its depth and speed over time.")
        self.caption.setObjectName("faint")
        self.caption.setWordWrap(True)
        self.of_depth = RecordPlot("depth")
        self.of_speed = RecordPlot("speed")
        self.of_discharge = RecordPlot("discharge", lambda units, value: value / units.metre**3)
        self.of_speed.hide()
        self.of_discharge.hide()
        self.setToolTip("Filled: the shown run; dashed: the run it is compared with")
        layout = QVBoxLayout(self)
        layout.setContentsMargins(6, 6, 6, 6)
        layout.addWidget(self.places)
        layout.addWidget(self.caption)
        for plot in (self.of_depth, self.of_speed, self.of_discharge):
            layout.addWidget(plot, 1)

    def show_status(self, status: ViewStatus) -> None:
        """Show the records of the chosen place."""
        self._show_places(status)
        if (text := _caption(status)) is not None:
            self.caption.setText(text)
        units = status.units
        self.of_depth.setLabel("left", f"depth [{units.length}]")
        self.of_speed.setLabel("left", f"speed [{units.speed}]")
        self.of_discharge.setLabel("left", f"discharge [{units.length}\u00b3/s]")
        for plot, ours, theirs in (
            (self.of_depth, status.depth_record, status.other_depth_record),
            (self.of_speed, status.speed_record, status.other_speed_record),
            (self.of_discharge, status.discharge_record, status.other_discharge_record),
        ):
            plot.show_records(ours, theirs, status)
        is_section = status.series_of is not None and status.series_of.kind == "section"
        self.of_depth.setVisible(not is_section)
        self.of_discharge.setVisible(is_section)
        self.of_speed.setVisible(bool(status.speed_record[0] or status.other_speed_record[0]))

    def _show_places(self, status: ViewStatus) -> None:
        if status.places != self._rows:
            self._rows = status.places
            self.places.clear()
            self.places.addItems([POINT, *(f"{row.kind.capitalize()} {row.id}" for row in self._rows)])
            self.places.setVisible(bool(self._rows))
        chosen = status.series_of
        self.places.setCurrentIndex(0 if chosen not in self._rows else 1 + self._rows.index(chosen))

    def _choose(self, number: int) -> None:
        row = self._rows[number - 1] if number > 0 else None
        self._dispatch(ShowSeries(None) if row is None else ShowSeries(row.id, row.kind))


def _caption(status: ViewStatus) -> str | None:
    """What is at the chosen place at the time shown; None where there is nothing to tell."""
    place, probe = status.series_of, status.probe
    if place is not None and place.kind == "section":
        times, values = status.discharge_record
        if not times:
            return f"Section {place.id}"
        now = float(np.interp(status.time, times, values))
        return f"Section {place.id}: {status.units.discharge_text(now)} to the right of its line"
    if probe is None:
        return None
    where = f"x {probe.x:.0f}, y {probe.y:.0f}" if place is None else f"Gauge {place.id}"
    return f"{where}: {readout_text(probe, status.units)}"
