"""The viewer in a window."""

from __future__ import annotations

import signal
import sys
from collections.abc import Callable

import moderngl
from PySide6.QtCore import QSettings, QTimer
from PySide6.QtWidgets import QApplication

from viewer.app.display import has_display
from viewer.app.stage import Stage
from viewer.app.viewer_app import ViewerApp
from viewer.errors import ContextError
from viewer.gui.kept_settings import KeptSettings
from viewer.gui.main_window import MainWindow
from viewer.gui.qt_start import start_qt

__all__ = ["make_window", "prepare_window", "run_window", "window_context"]

EXIT_NO_PICTURE = 3


def window_context() -> moderngl.Context:
    """Return the OpenGL context that the toolkit made current.

    Raises:
        ContextError: moderngl cannot use it.
    """
    try:
        return moderngl.create_context()
    except Exception as first:
        # Under Wayland, or with Qt on EGL, the context belongs to EGL and the first look finds none.
        try:
            return moderngl.create_context(backend="egl")  # type: ignore[arg-type]
        except Exception:
            raise ContextError(
                f"OpenGL 4.1 is needed, but the window has no usable context: {first}"
            ) from first


def prepare_window() -> QApplication:
    """Return the running Qt application, started if need be.

    Raises:
        ContextError: there is no display, or a system library is missing.
    """
    if not has_display():
        raise ContextError(
            "there is no display for a window: set DISPLAY or WAYLAND_DISPLAY, or use --headless DIR"
        )
    return start_qt(sys.argv[:1])


def make_window(
    app: ViewerApp, closed: Callable[[], None] | None = None, kept: KeptSettings | None = None
) -> MainWindow:
    """Return the window of `app`, not shown yet; Qt must be running."""
    return MainWindow(app, Stage(app, window_context), closed, kept)


def run_window(app: ViewerApp, closed: Callable[[], None]) -> int:
    """Show the window until it is closed; return the exit status.

    Args:
        app: the state machine.
        closed: called once when the window closes.

    Raises:
        ContextError: there is no display, or a system library is missing.
    """
    application = prepare_window()
    window = make_window(app, closed, KeptSettings(QSettings()))
    interrupted = signal.signal(signal.SIGINT, lambda *_: window.close())
    wake = QTimer()  # lets Python look at signals while Qt waits
    wake.timeout.connect(lambda: None)
    wake.start(200)
    window.show()
    try:
        status = application.exec()
    finally:
        signal.signal(signal.SIGINT, interrupted)
        wake.stop()
    if window.failure is not None:
        print(f"fev-viewer: {window.failure}", file=sys.stderr)
        return EXIT_NO_PICTURE
    return status
