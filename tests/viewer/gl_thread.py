"""An off-screen context that is still current keeps Qt from making its own current in the same thread."""

import contextlib
import ctypes


def let_go_of_egl() -> None:
    """Leave this thread without a current EGL context; where there is no EGL there is nothing to leave."""
    with contextlib.suppress(OSError):
        ctypes.CDLL("libEGL.so.1").eglReleaseThread()
