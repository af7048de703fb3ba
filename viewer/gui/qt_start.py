"""Start Qt, or say in one sentence what this machine lacks.

Qt aborts the whole process when its platform plugin does not load; what it would miss is therefore looked up
before. The library names are those that the xcb plugin of Qt 6 loads on Linux, with the Debian packages
that hold them.
"""

from __future__ import annotations

import ctypes
import sys

from PySide6.QtGui import QSurfaceFormat
from PySide6.QtWidgets import QApplication

from viewer.errors import ContextError
from viewer.gui.scene_widget import surface_format
from viewer.gui.theme import apply_theme

__all__ = ["missing_packages", "start_qt"]

XCB_LIBRARIES = {
    "libxcb-cursor.so.0": "libxcb-cursor0",
    "libxcb-icccm.so.4": "libxcb-icccm4",
    "libxcb-image.so.0": "libxcb-image0",
    "libxcb-keysyms.so.1": "libxcb-keysyms1",
    "libxcb-randr.so.0": "libxcb-randr0",
    "libxcb-render-util.so.0": "libxcb-render-util0",
    "libxcb-shape.so.0": "libxcb-shape0",
    "libxcb-xkb.so.1": "libxcb-xkb1",
    "libxkbcommon-x11.so.0": "libxkbcommon-x11-0",
    "libGL.so.1": "libgl1",
    "libEGL.so.1": "libegl1",
}


def missing_packages(libraries: dict[str, str] = XCB_LIBRARIES) -> list[str]:
    """Return the Debian packages of those `libraries` (file name to package) that cannot be loaded."""
    missing = []
    for library, package in libraries.items():
        try:
            ctypes.CDLL(library)
        except OSError:
            missing.append(package)
    return missing


def start_qt(arguments: list[str]) -> QApplication:
    """Return the application object with format and theme set.

    Raises:
        ContextError: there is no display, or Qt would not start for want of system libraries.
    """
    running = QApplication.instance()
    if isinstance(running, QApplication):
        return running
    if sys.platform.startswith("linux") and (missing := missing_packages()):
        raise ContextError(
            f"Qt cannot open a window without these system packages: sudo apt-get install {' '.join(missing)}"
        )
    QSurfaceFormat.setDefaultFormat(surface_format())
    application = QApplication(arguments)
    application.setOrganizationName("fev")
    application.setApplicationName("fev-viewer")
    application.setApplicationDisplayName("Flood Emergency Visualizer")
    apply_theme(application)
    return application
