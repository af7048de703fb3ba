"""The picture: a QOpenGLWidget that hands its framebuffer to a painter and its events to the tools."""

from __future__ import annotations

import time
from collections.abc import Sequence

from PySide6.QtCore import QEvent, QPointF, Qt, Signal
from PySide6.QtGui import (
    QFocusEvent,
    QKeyEvent,
    QMouseEvent,
    QNativeGestureEvent,
    QSurfaceFormat,
    QWheelEvent,
)
from PySide6.QtOpenGLWidgets import QOpenGLWidget
from PySide6.QtWidgets import QWidget

from viewer.commands import Command, GrabView, Zoom
from viewer.errors import ViewerError
from viewer.gui.conductor import Conductor, Painter
from viewer.gui.key_names import name_of_key
from viewer.tools import Bindings, PointerEvent, Toolbox
from viewer.tools.pointer import Button, PointerKind

__all__ = ["SceneWidget", "surface_format"]

WHEEL_NOTCH = 120.0
FRAME_RATE_SMOOTHING = 0.9
PINCH_STEPS = 6.0
"""Wheel notches that a pinch to twice the size is worth."""
_PINCH = Qt.NativeGestureType.ZoomNativeGesture

_BUTTONS: dict[Qt.MouseButton, Button] = {
    Qt.MouseButton.LeftButton: "left",
    Qt.MouseButton.MiddleButton: "middle",
    Qt.MouseButton.RightButton: "right",
}


def surface_format() -> QSurfaceFormat:
    """Return the format asked of every window: OpenGL 4.1 core, which macOS and old graphics chips have."""
    wanted = QSurfaceFormat()
    wanted.setRenderableType(QSurfaceFormat.RenderableType.OpenGL)
    wanted.setVersion(4, 1)
    wanted.setProfile(QSurfaceFormat.OpenGLContextProfile.CoreProfile)
    wanted.setDepthBufferSize(24)
    wanted.setSwapInterval(1)
    return wanted


class SceneWidget(QOpenGLWidget):
    """The picture of the flood.

    Signals:
        failed: no picture can be drawn; the text says why.
        resized: the picture has another size.

    Attributes:
        frames_per_second: smoothed rate of the pictures drawn in a row.
        pictures: number of pictures drawn.
    """

    failed = Signal(str)
    resized = Signal()

    def __init__(self, conductor: Conductor, painter: Painter, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setFormat(surface_format())
        self.setMinimumSize(320, 240)
        self.setMouseTracking(True)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setAccessibleName("Picture of the flood")
        self._conductor = conductor
        self._painter = painter
        self._toolbox = Toolbox()
        self._hover: tuple[QPointF, Button] | None = None
        self._is_open = False
        self._last_paint = 0.0
        self.frames_per_second = 0.0
        self.pictures = 0

    @property
    def render_scale(self) -> float:
        """Pixels of the scene for each pixel of the picture, along one side."""
        return self._painter.render_scale if self._is_open else 1.0

    def initializeGL(self) -> None:
        """Hand the new context to the painter."""
        try:
            self._painter.open()
        except ViewerError as error:
            self.failed.emit(str(error))
            return
        self._is_open = True
        self.context().aboutToBeDestroyed.connect(self.release)

    def resizeGL(self, width: int, height: int) -> None:
        """Tell what lies on the picture that it has another size."""
        self.resized.emit()

    def paintGL(self) -> None:
        """Draw the scene; then look up what lies under the pointer, while the depths are at hand."""
        if not self._is_open:
            return
        ratio = self.devicePixelRatio()
        width, height = max(1, round(self.width() * ratio)), max(1, round(self.height() * ratio))
        self._painter.paint(self.defaultFramebufferObject(), width, height)
        self._count_picture()
        if self._hover is not None:
            (position, button), self._hover = self._hover, None
            self._send(self._toolbox.pointer(self._pointer("move", position, button), tool=self._tool))

    def release(self) -> None:
        """Release the painter's objects while the context still lives. May be called twice."""
        if self._is_open:
            self._is_open = False
            self.makeCurrent()
            self._painter.close()
            self.doneCurrent()

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Pass a press on to the tools."""
        self._mouse("press", event, with_ground=True)

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        """Pass a double click on to the tools."""
        self._mouse("double", event, with_ground=True)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Pass a release on to the tools."""
        self._mouse("release", event, with_ground=True)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Pass a drag of the camera on at once; a hover and a drag of a tool wait for the next picture."""
        is_tool_drag = bool(self._tool) and bool(event.buttons() & Qt.MouseButton.LeftButton)
        if is_tool_drag or event.buttons() == Qt.MouseButton.NoButton:
            self._hover = (event.position(), "left" if is_tool_drag else "none")
            self.update()
            return
        held = next((button for button in _BUTTONS if event.buttons() & button), Qt.MouseButton.NoButton)
        self._mouse("move", event, with_ground=False, button=held)

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Pass the wheel on to the tools, and two fingers on a trackpad."""
        event.accept()
        if event.phase() != Qt.ScrollPhase.NoScrollPhase:
            self._scroll(event)
            return
        steps = event.angleDelta().y() / WHEEL_NOTCH
        pointer = self._pointer("wheel", event.position(), "none", steps=steps)
        self._send(self._toolbox.pointer(pointer, tool=self._tool))

    def event(self, event: QEvent) -> bool:
        """Pass a pinch on a trackpad on: it comes nearer or goes away."""
        if isinstance(event, QNativeGestureEvent) and event.gestureType() == _PINCH:
            self._send([Zoom(PINCH_STEPS * event.value())])
            return True
        return super().event(event)

    def bind(self, bindings: Bindings) -> None:
        """Let keys and mouse do what the tables say."""
        self._toolbox.bind(bindings)

    def leaveEvent(self, event: QEvent) -> None:
        """The pointer is over the picture no more."""
        self._hover = None
        self._send(self._toolbox.orbit.handle(PointerEvent("leave", 0.0, 0.0)))
        super().leaveEvent(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Pass a key on to the tools."""
        name = name_of_key(event.key())
        if not name or event.modifiers() & Qt.KeyboardModifier.ControlModifier:
            super().keyPressEvent(event)
        elif not event.isAutoRepeat():
            commands = self._toolbox.key_pressed(name, tool=self._tool)
            self._send(commands) if commands else super().keyPressEvent(event)

    def keyReleaseEvent(self, event: QKeyEvent) -> None:
        """Pass a key on to the tools."""
        name = name_of_key(event.key())
        if not name:
            super().keyReleaseEvent(event)
        elif not event.isAutoRepeat():
            self._send(self._toolbox.key_released(name))

    def focusOutEvent(self, event: QFocusEvent) -> None:
        """Without the keyboard no key is held."""
        self._send(self._toolbox.keyboard_lost())
        super().focusOutEvent(event)

    def _scroll(self, event: QWheelEvent) -> None:
        if event.phase() in (Qt.ScrollPhase.ScrollBegin, Qt.ScrollPhase.ScrollEnd):
            self._send([GrabView(event.phase() == Qt.ScrollPhase.ScrollBegin)])
        height = max(1, self.height())
        delta = event.pixelDelta()
        if delta.x() or delta.y():
            pointer = PointerEvent("scroll", 0.0, 0.0, dx=delta.x() / height, dy=delta.y() / height)
            self._send(self._toolbox.orbit.handle(pointer))

    @property
    def _tool(self) -> str:
        status = self._conductor.status()
        return "measure" if status.is_measuring else status.edit_tool

    def _mouse(
        self,
        kind: PointerKind,
        event: QMouseEvent,
        *,
        with_ground: bool,
        button: Qt.MouseButton | None = None,
    ) -> None:
        if kind != "move":
            self._hover = None  # what went before a press or a release is over
        name = _BUTTONS.get(event.button() if button is None else button, "none")
        shift = bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier)
        pointer = self._pointer(kind, event.position(), name, shift=shift, with_ground=with_ground)
        self._send(self._toolbox.pointer(pointer, tool=self._tool))
        event.accept()

    def _pointer(
        self,
        kind: PointerKind,
        position: QPointF,
        button: Button,
        *,
        shift: bool = False,
        steps: float = 0.0,
        with_ground: bool = True,
    ) -> PointerEvent:
        ground = None
        if with_ground and self._is_open:
            ratio = self.devicePixelRatio()
            self.makeCurrent()
            ground = self._painter.ground_at(position.x() * ratio, position.y() * ratio)
        height = max(1, self.height())
        return PointerEvent(kind, position.x() / height, position.y() / height, button, shift, steps, ground)

    def _send(self, commands: Sequence[Command]) -> None:
        for command in commands:
            self._conductor.dispatch(command)

    def _count_picture(self) -> None:
        now = time.monotonic()
        span = now - self._last_paint
        self._last_paint = now
        self.pictures += 1
        if 0.0 < span < 1.0:
            rate = 1.0 / span
            keep = FRAME_RATE_SMOOTHING if self.frames_per_second > 0.0 else 0.0
            self.frames_per_second = keep * self.frames_per_second + (1.0 - keep) * rate
