import os
import subprocess
import sys

import moderngl
import pytest

from viewer.errors import ContextError
from viewer.render import check_context
from viewer.render.context import create_headless_context

pytestmark = pytest.mark.gl

ATTEMPT = (
    "from viewer.errors import ContextError\n"
    "from viewer.render import create_headless_context\n"
    "try:\n"
    "    print(create_headless_context().version_code)\n"
    "except ContextError as error:\n"
    "    print(error)\n"
)


def attempt(**environment: str) -> str:
    done = subprocess.run(
        [sys.executable, "-c", ATTEMPT],
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        timeout=60,
        check=True,
    )
    return done.stdout.strip()


def test_a_context_needs_no_display() -> None:
    assert int(attempt(DISPLAY="")) >= 410


def test_an_older_driver_is_told_with_its_version() -> None:
    answer = attempt(MESA_GL_VERSION_OVERRIDE="3.3", MESA_GLSL_VERSION_OVERRIDE="330")

    assert "OpenGL 4.1 is needed" in answer
    assert "3.3" in answer


def test_a_machine_without_a_driver_is_told_which_packages_are_missing() -> None:
    answer = attempt(__EGL_VENDOR_LIBRARY_FILENAMES="/nonexistent.json")

    assert "libegl1" in answer
    assert "libgl1-mesa-dri" in answer


def test_a_window_with_an_old_context_is_refused() -> None:
    class Old:
        version_code = 330
        info = {"GL_RENDERER": "An Old Card"}  # noqa: RUF012

    with pytest.raises(ContextError, match=r"4\.1 is needed, An Old Card offers 3\.3"):
        check_context(Old())


def test_a_good_context_passes(ctx: moderngl.Context) -> None:
    assert check_context(ctx) is ctx
    assert create_headless_context is not None
