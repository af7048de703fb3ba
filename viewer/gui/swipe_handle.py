"""The grip of the divider between two runs: dragged with the mouse, moved with the arrow keys."""

from __future__ import annotations

from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QColor, QKeyEvent, QMouseEvent, QPainter, QPaintEvent
from PySide6.QtWidgets import QWidget

from viewer.commands import MoveSwipe
from viewer.gui.conductor import Dispatch
from viewer.view_status import ViewStatus

__all__ = ["SwipeHandle"]

GRIP = (26, 46)
"""Width and height [pixels]."""
KEY_STEP = 0.02
"""How far an arrow key moves the divider, as a share of the width."""


class SwipeHandle(QWidget):
    """Lies on the picture over the divider.

    Args:
        dispatch: carries out the commands.
        scene: the picture.
    """

    def __init__(self, dispatch: Dispatch, scene: QWidget) -> None:
        super().__init__(scene)
        self._dispatch = dispatch
        self._scene = scene
        self._at: float | None = None
        self.setFixedSize(*GRIP)
        self.setCursor(Qt.CursorShape.SplitHCursor)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setAccessibleName("Divider between two runs")
        self.setToolTip("Drag to see more of one run; with the keyboard: left, right, Home (middle)")
        self.hide()

    def show_status(self, status: ViewStatus) -> None:
        """Stand where the divider stands, or nowhere."""
        self._at = status.swipe_at
        self.setVisible(self._at is not None)
        self.place()

    def place(self) -> None:
        """Follow the size of the picture."""
        scene = self._scene
        if self._at is not None:
            at = round(self._at * scene.width()) - self.width() // 2
            self.move(at, scene.height() // 2 - self.height() // 2)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Take the grip."""
        event.accept()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Drag the divider."""
        scene = self._scene
        if event.buttons() & Qt.MouseButton.LeftButton and scene.width() > 0:
            self._move_to(self.mapTo(scene, event.position()).x() / scene.width())
        event.accept()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Move the divider by a step."""
        steps = {Qt.Key.Key_Left: -KEY_STEP, Qt.Key.Key_Right: KEY_STEP}
        key = Qt.Key(event.key())
        if key == Qt.Key.Key_Home:
            self._move_to(0.5)
        elif key in steps and self._at is not None:
            self._move_to(self._at + steps[key])
        else:
            super().keyPressEvent(event)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the grip: two arrows that point away from the line."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(61, 155, 224) if self.hasFocus() else QColor(250, 250, 250))
        painter.drawRoundedRect(self.rect(), 6.0, 6.0)
        painter.setBrush(QColor(30, 40, 52))
        middle = self.height() / 2
        for tip, foot in ((4.0, 10.0), (self.width() - 4.0, self.width() - 10.0)):
            painter.drawPolygon(
                [QPointF(tip, middle), QPointF(foot, middle - 6.0), QPointF(foot, middle + 6.0)]
            )

    def _move_to(self, at: float) -> None:
        self._at = min(max(at, 0.03), 0.97)
        self.place()
        self._dispatch(MoveSwipe(self._at))
