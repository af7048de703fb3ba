"""One thread, two worlds: an off-screen context still current keeps Qt from making its own current."""

import contextlib
import ctypes


def let_go_of_egl() -> None:
    """Leave this thread without a current EGL context; where there is no EGL there is nothing to leave."""
    with contextlib.suppress(OSError):
        ctypes.CDLL("libEGL.so.1").eglReleaseThread()
