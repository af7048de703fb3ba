"""Water depth against time at the point that was clicked last."""

from __future__ import annotations

import pyqtgraph as pg
from PySide6.QtWidgets import QLabel, QSizePolicy, QVBoxLayout, QWidget

from viewer.gui.status_line import readout_text
from viewer.gui.theme import ACCENT, BRANCH
from viewer.view_status import ViewStatus

__all__ = ["DepthPlot"]


class DepthPlot(QWidget):
    """A small plot; the vertical line is the time shown."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.caption = QLabel("Click the ground to see its depth over time.")
        self.caption.setObjectName("faint")
        self.caption.setWordWrap(True)
        self.plot = pg.PlotWidget(background=None)
        self.plot.setAccessibleName("Depth over time at the clicked point")
        self.plot.setMinimumHeight(120)
        self.plot.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Ignored)
        self.plot.setMenuEnabled(False)
        self.plot.setMouseEnabled(False, False)
        self.plot.hideButtons()
        self.plot.setLabel("left", "depth [m]")
        self.plot.setLabel("bottom", "time [min]")
        self.plot.showGrid(x=True, y=True, alpha=0.15)
        self.curve = self.plot.plot(pen=pg.mkPen(ACCENT, width=2), fillLevel=0.0, brush=(61, 155, 224, 60))
        self.now = pg.InfiniteLine(angle=90, pen=pg.mkPen(BRANCH, width=1))
        self.plot.addItem(self.now)
        self._shown: tuple[tuple[float, ...], tuple[float, ...]] = ((), ())
        layout = QVBoxLayout(self)
        layout.setContentsMargins(6, 6, 6, 6)
        layout.addWidget(self.caption)
        layout.addWidget(self.plot, 1)

    def show_status(self, status: ViewStatus) -> None:
        """Show the record of the probed point."""
        if status.probe is not None:
            place = f"x {status.probe.x:.0f}, y {status.probe.y:.0f}: "
            self.caption.setText(place + readout_text(status.probe, status.units))
        self.now.setPos(status.time / 60.0)
        if status.duration > 0.0:
            self.plot.setXRange(0.0, status.duration / 60.0, padding=0.02)
        if status.depth_record != self._shown:
            self._shown = status.depth_record
            times, depths = status.depth_record
            self.curve.setData([time / 60.0 for time in times], list(depths))
