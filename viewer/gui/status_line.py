"""The line at the bottom: connection, time, speed, trust in the numbers, what lies under the pointer."""

from __future__ import annotations

from PySide6.QtWidgets import QLabel, QSizePolicy, QStatusBar, QWidget

from viewer.units import METRIC, Units
from viewer.view_status import PointReadout, ViewStatus, time_text

__all__ = ["StatusLine", "age_text", "readout_text"]


AGE_TOLD_S = 5.0
"""A connected service that was heard within this time counts as present [s]."""


def readout_text(readout: PointReadout | None, units: Units = METRIC) -> str:
    """Return depth, level and ground at a point in words."""
    if readout is None:
        return ""
    ground = f"ground {units.length_text(readout.ground)}"
    if readout.level is None:
        return f"dry, {ground}"
    depth, level = units.length_text(readout.depth), units.length_text(readout.level)
    flow = ""
    if readout.speed is not None:
        toward = "" if readout.bearing is None else f" toward {readout.bearing:.0f}\u00b0"
        flow = f", {units.speed_text(readout.speed)}{toward}"
    return f"depth {depth}{flow}, level {level}, {ground}"


def age_text(status: ViewStatus) -> str:
    """Return how old the data on the picture is, in words; empty before any came."""
    if status.data_age is None:
        return ""
    if status.is_connected and status.data_age < AGE_TOLD_S:
        return "data up to date"
    return f"data {time_text(status.data_age)} old"


class StatusLine(QStatusBar):
    """Permanent labels, the message on the left."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setSizeGripEnabled(False)
        self.message = self._label("Message", stretch=1)
        # A long message is cut, with all of it in the tip; the window does not grow for it.
        self.message.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        self.point = self._label("Under the pointer")
        self.time = self._label("Model and clock time")
        self.revision = self._label("Revision of the edits")
        self.computation = self._label("Computation")
        self.volume = self._label("Water volume error")
        self.rate = self._label("Pictures per second")
        self.age = self._label("Age of the data")
        self.connection = self._label("Connection")

    def show_status(self, status: ViewStatus, frames_per_second: float, render_scale: float = 1.0) -> None:
        """Show the state.

        Args:
            status: the state.
            frames_per_second: pictures a second.
            render_scale: pixels of the scene for each pixel of the picture, along one side.
        """
        told = status.measured or status.message
        self.message.setText(told)
        self.message.setToolTip(told)
        self.point.setText(readout_text(status.hover, status.units))
        self.time.setText(" ".join(filter(None, (time_text(status.time), status.clock))))
        self.revision.setText(f"edits rev {status.revision}" if status.has_terrain else "")
        self.age.setText(age_text(status))
        speed = status.speed_x_real_time
        self.computation.setText("" if speed is None else f"{speed:.0f} x real time")
        error = status.volume_error_relative
        self.volume.setText("" if error is None else f"volume error {error:.1e}")
        sharpness = f" at {100.0 * render_scale:.0f} %" if render_scale < 1.0 else ""
        self.rate.setText(f"{frames_per_second:.0f} fps{sharpness}" if frames_per_second > 0.0 else "")
        self.rate.setToolTip("Pictures a second" + (", and how fine the scene is drawn" if sharpness else ""))
        self.connection.setText(status.connection)

    def _label(self, name: str, stretch: int = 0) -> QLabel:
        label = QLabel("")
        label.setAccessibleName(name)
        if stretch:
            self.addWidget(label, stretch)
        else:
            self.addPermanentWidget(label)
        return label
