"""The reference map in the corner of the picture: where the camera is, what it sees, where the water is."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QImage, QMouseEvent, QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QSizePolicy, QWidget

from viewer.commands import FlyTo
from viewer.gui.conductor import Dispatch
from viewer.gui.theme import BRANCH
from viewer.world import MapView

__all__ = ["ReferenceMap"]

LONGEST_SIDE = 210
FRAME = 4
WATER = (46, 120, 210)
TRAVEL_S = 0.8


class ReferenceMap(QWidget):
    """A small map, north up; a click or drag on it takes the camera there."""

    def __init__(self, dispatch: Dispatch, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._dispatch = dispatch
        self._view: MapView | None = None
        self._image = QImage()
        self.setAccessibleName("Reference map")
        self.setToolTip("Where the camera is and what it sees; click to travel")
        self.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Fixed)
        self.setCursor(Qt.CursorShape.PointingHandCursor)
        self.hide()

    def sizeHint(self) -> QSize:
        """As wide or as high as allowed, in the shape of the terrain."""
        if self._view is None:
            return QSize(LONGEST_SIDE, LONGEST_SIDE)
        west, south, east, north = self._view.extent
        scale = LONGEST_SIDE / max(east - west, north - south)
        return QSize(
            max(24, round(scale * (east - west))) + 2 * FRAME,
            max(24, round(scale * (north - south))) + 2 * FRAME,
        )

    def show_map(self, view: MapView | None) -> None:
        """Show a map; None hides what is shown."""
        if view is self._view:
            return
        before, self._view = self._view, view
        if view is None:
            return
        if before is None or before.relief is not view.relief or before.flood is not view.flood:
            self._image = _painted(view)
        self.resize(self.sizeHint())
        self.update()

    def place_at(self, position: QPointF) -> tuple[float, float] | None:
        """Grid coordinates [m] under a point of the widget, clamped to the map; None without a map."""
        if self._view is None:
            return None
        west, south, east, north = self._view.extent
        inside = self._inside()
        across = min(max((position.x() - inside.left()) / inside.width(), 0.0), 1.0)
        down = min(max((position.y() - inside.top()) / inside.height(), 0.0), 1.0)
        return west + across * (east - west), north - down * (north - south)

    def position_of(self, x: float, y: float) -> QPointF:
        """Point of the widget that stands for grid coordinates (x, y) [m]; the centre without a map."""
        inside = self._inside()
        if self._view is None:
            return inside.center()
        west, south, east, north = self._view.extent
        return QPointF(
            inside.left() + (x - west) / (east - west) * inside.width(),
            inside.top() + (north - y) / (north - south) * inside.height(),
        )

    def paintEvent(self, event: QPaintEvent) -> None:
        """Relief and flood, the ground in view, the eye and its direction."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.fillRect(self.rect(), QColor(14, 24, 34, 190))
        if self._view is None:
            return
        inside = self._inside()
        painter.drawImage(inside, self._image)
        painter.setClipRect(inside)
        seen = QPolygonF([self.position_of(x, y) for x, y in self._view.in_view])
        painter.setPen(QPen(QColor(255, 255, 255, 210), 1.2))
        painter.setBrush(QColor(255, 255, 255, 46))
        painter.drawPolygon(seen)
        eye, target = self.position_of(*self._view.eye), self.position_of(*self._view.target)
        painter.setPen(QPen(QColor(BRANCH), 1.6))
        painter.drawLine(eye, target)
        painter.setBrush(QColor(BRANCH))
        painter.setPen(QPen(QColor(20, 24, 28), 1.0))
        painter.drawEllipse(eye, 4.0, 4.0)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setPen(QPen(QColor(BRANCH), 1.6))
        painter.drawEllipse(target, 3.0, 3.0)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Travel to the point clicked."""
        if event.button() == Qt.MouseButton.LeftButton:
            self._travel(event.position(), TRAVEL_S)
        event.accept()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Follow a drag."""
        if event.buttons() & Qt.MouseButton.LeftButton:
            self._travel(event.position(), 0.0)
        event.accept()

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Nothing is left to do; the picture below shall not hear of it."""
        event.accept()

    def _travel(self, position: QPointF, seconds: float) -> None:
        place = self.place_at(position)
        if place is not None:
            self._dispatch(FlyTo(*place, seconds=seconds))

    def _inside(self) -> QRectF:
        return QRectF(self.rect()).adjusted(FRAME, FRAME, -FRAME, -FRAME)


def _painted(view: MapView) -> QImage:
    pixels = view.relief.astype(np.float32)
    pixels[view.flood] = 0.25 * pixels[view.flood] + 0.75 * np.array(WATER, np.float32)
    raw = np.ascontiguousarray(pixels.astype(np.uint8))
    rows, cols = raw.shape[:2]
    return QImage(raw.tobytes(), cols, rows, 3 * cols, QImage.Format.Format_RGB888).copy()
