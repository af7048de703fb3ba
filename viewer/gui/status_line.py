"""The line at the bottom: connection, time, speed, trust in the numbers, what lies under the pointer."""

from __future__ import annotations

from PySide6.QtWidgets import QLabel, QStatusBar, QWidget

from viewer.view_status import PointReadout, ViewStatus

__all__ = ["StatusLine", "readout_text"]


def readout_text(readout: PointReadout | None) -> str:
    """Return depth, level and ground at a point in words."""
    if readout is None:
        return ""
    ground = f"ground {readout.ground:.2f} m"
    if readout.level is None:
        return f"dry, {ground}"
    return f"depth {readout.depth:.2f} m, level {readout.level:.2f} m, {ground}"


class StatusLine(QStatusBar):
    """Permanent labels, the message on the left."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setSizeGripEnabled(False)
        self.message = self._label("Message", stretch=1)
        self.point = self._label("Under the pointer")
        self.computation = self._label("Computation")
        self.volume = self._label("Water volume error")
        self.rate = self._label("Pictures per second")
        self.connection = self._label("Connection")

    def show_status(self, status: ViewStatus, frames_per_second: float) -> None:
        """Show the state."""
        self.message.setText(status.message)
        self.point.setText(readout_text(status.hover))
        speed = status.speed_x_real_time
        self.computation.setText("" if speed is None else f"{speed:.0f} x real time")
        error = status.volume_error_relative
        self.volume.setText("" if error is None else f"volume error {error:.1e}")
        self.rate.setText(f"{frames_per_second:.0f} fps" if frames_per_second > 0.0 else "")
        self.connection.setText(status.connection)

    def _label(self, name: str, stretch: int = 0) -> QLabel:
        label = QLabel("")
        label.setAccessibleName(name)
        if stretch:
            self.addWidget(label, stretch)
        else:
            self.addPermanentWidget(label)
        return label
