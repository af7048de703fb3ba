"""Depth and speed of the water against time at the point that was clicked last."""

from __future__ import annotations

import pyqtgraph as pg
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QLabel, QSizePolicy, QVBoxLayout, QWidget

from viewer.gui.status_line import readout_text
from viewer.gui.theme import ACCENT, BRANCH
from viewer.view_status import ViewStatus

__all__ = ["DepthPlot", "RecordPlot"]

OTHER = (232, 148, 204)
"""Colour of the run that is compared with."""
LEAST_HIGH = 0.1
"""The axis reaches at least so far, in the unit shown: dry ground is a line at its foot."""
Record = tuple[tuple[float, ...], tuple[float, ...]]


class RecordPlot(pg.PlotWidget):
    """One quantity against time; the vertical line is the time shown.

    Attributes:
        curve: the shown run.
        other: the run that it is compared with, dashed.
        now: the time shown.
    """

    def __init__(self, name: str) -> None:
        super().__init__(background=None)
        self.setAccessibleName(f"{name.capitalize()} over time at the clicked point")
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
        self._shown: tuple[Record, Record] = (((), ()), ((), ()))

    def show_records(self, ours: Record, theirs: Record, time: float, duration: float) -> None:
        """Draw the records of both runs; times in s."""
        self.now.setPos(time / 60.0)
        if duration > 0.0:
            self.setXRange(0.0, duration / 60.0, padding=0.02)
        if (ours, theirs) != self._shown:
            self._shown = (ours, theirs)
            for curve, (times, values) in ((self.curve, ours), (self.other, theirs)):
                curve.setData([at / 60.0 for at in times], list(values))
            highest = max((*ours[1], *theirs[1]), default=0.0)
            self.setYRange(0.0, max(highest, LEAST_HIGH), padding=0.05)


class DepthPlot(QWidget):
    """The dock of the clicked point: what is there, depth over time and, where known, speed over time."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.caption = QLabel("Click the ground to see its depth and speed over time.")
        self.caption.setObjectName("faint")
        self.caption.setWordWrap(True)
        self.of_depth = RecordPlot("depth")
        self.of_speed = RecordPlot("speed")
        self.of_speed.hide()
        self.setToolTip("Filled: the shown run; dashed: the run it is compared with")
        layout = QVBoxLayout(self)
        layout.setContentsMargins(6, 6, 6, 6)
        layout.addWidget(self.caption)
        layout.addWidget(self.of_depth, 1)
        layout.addWidget(self.of_speed, 1)

    def show_status(self, status: ViewStatus) -> None:
        """Show the records of the probed point."""
        if status.probe is not None:
            place = f"x {status.probe.x:.0f}, y {status.probe.y:.0f}: "
            self.caption.setText(place + readout_text(status.probe, status.units))
        units = status.units
        self.of_depth.setLabel("left", f"depth [{units.length}]")
        self.of_speed.setLabel("left", f"speed [{units.speed}]")
        for plot, ours, theirs in (
            (self.of_depth, status.depth_record, status.other_depth_record),
            (self.of_speed, status.speed_record, status.other_speed_record),
        ):
            shown, other = ((times, tuple(map(units.shown, values))) for times, values in (ours, theirs))
            plot.show_records(shown, other, status.time, status.duration)
        self.of_speed.setVisible(bool(status.speed_record[0] or status.other_speed_record[0]))
