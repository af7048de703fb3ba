"""The time bar: what is computed, where the branch begins, where playback stands."""

from __future__ import annotations

from PySide6.QtCore import QPointF, QRectF, Qt, Signal
from PySide6.QtGui import QColor, QMouseEvent, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QSlider, QWidget

from viewer.gui.theme import ACCENT, BRANCH, COMPUTED, TRACK
from viewer.view_status import time_text

__all__ = ["TimeSlider"]

STEPS = 10_000
MARGIN = 10.0
TRACK_HEIGHT = 8.0
HANDLE_RADIUS = 8.0


class TimeSlider(QSlider):
    """A slider over the run's duration that lets nobody go beyond what is computed.

    Signals:
        time_chosen: a time [s] that the user asked for by mouse or keyboard.
    """

    time_chosen = Signal(float)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(Qt.Orientation.Horizontal, parent)
        self.setRange(0, STEPS)
        self.setSingleStep(STEPS // 200)
        self.setPageStep(STEPS // 20)
        self.setMinimumHeight(28)
        self.setMouseTracking(True)
        self.setAccessibleName("Playback time")
        self._duration = 1.0
        self._computed_until = 0.0
        self._branch_time: float | None = None
        self.actionTriggered.connect(self._chosen_by_keyboard)

    def show_times(
        self, time: float, computed_until: float, duration: float, branch_time: float | None
    ) -> None:
        """Show the playback time, the computed range and the branch point [s]."""
        self._duration = max(duration, 1e-9)
        self._computed_until = computed_until
        self._branch_time = branch_time
        blocked = self.blockSignals(True)
        self.setValue(round(STEPS * time / self._duration))
        self.blockSignals(blocked)
        self.update()

    def position_of(self, time: float) -> float:
        """Return the horizontal position of a time [pixels]."""
        return MARGIN + (self.width() - 2.0 * MARGIN) * min(time / self._duration, 1.0)

    def time_at(self, x: float) -> float:
        """Return the time under a horizontal position [s], held inside the computed range."""
        share = (x - MARGIN) / max(self.width() - 2.0 * MARGIN, 1.0)
        return min(max(share, 0.0) * self._duration, self._computed_until)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Jump to where the user presses."""
        if event.button() == Qt.MouseButton.LeftButton:
            self.time_chosen.emit(self.time_at(event.position().x()))
            event.accept()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Follow a drag; tell the time under the pointer otherwise."""
        time = self.time_at(event.position().x())
        self.setToolTip(time_text(time))
        if event.buttons() & Qt.MouseButton.LeftButton:
            self.time_chosen.emit(time)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """End of a drag: nothing is left to do."""
        event.accept()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw track, computed range, branch mark and handle."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(Qt.PenStyle.NoPen)
        middle = 0.5 * self.height()
        top = middle - 0.5 * TRACK_HEIGHT
        now = self.position_of(self._duration * self.value() / STEPS)
        for colour, end in (
            (TRACK, self.width() - MARGIN),
            (COMPUTED, self.position_of(self._computed_until)),
            (ACCENT, now),
        ):
            painter.setBrush(QColor(colour))
            painter.drawRoundedRect(QRectF(MARGIN, top, max(end - MARGIN, 0.0), TRACK_HEIGHT), 4.0, 4.0)
        if self._branch_time is not None:
            x = self.position_of(self._branch_time)
            painter.setPen(QPen(QColor(BRANCH), 2.0))
            painter.drawLine(QPointF(x, top - 5.0), QPointF(x, top + TRACK_HEIGHT + 5.0))
        painter.setPen(QPen(QColor("#ffffff" if self.hasFocus() else "#cfd6dc"), 2.0))
        painter.setBrush(QColor(ACCENT))
        painter.drawEllipse(QPointF(now, middle), HANDLE_RADIUS, HANDLE_RADIUS)

    def _chosen_by_keyboard(self, _action: int) -> None:
        self.time_chosen.emit(min(self._duration * self.sliderPosition() / STEPS, self._computed_until))
