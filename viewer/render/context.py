"""OpenGL contexts: one without a window, and the check of one that a window made."""

from __future__ import annotations

from typing import Any

import moderngl

from viewer.errors import ContextError

__all__ = ["check_context", "create_headless_context"]

REQUIRED_VERSION = 410
_MISSING = "on Debian or Ubuntu install the packages libegl1 and libgl1-mesa-dri"


def create_headless_context() -> moderngl.Context:
    """An OpenGL 4.1 core context that needs no window and no display (EGL).

    Raises:
        ContextError: naming the missing packages, or the version found if it is below 4.1.
    """
    try:
        ctx = _create(REQUIRED_VERSION)
    except Exception as error:  # glcontext raises plain Exception, whatever went wrong
        raise ContextError(_explain(error)) from error
    return check_context(ctx)


def check_context(ctx: moderngl.Context) -> moderngl.Context:
    """The same context if it is good enough.

    Raises:
        ContextError: if it is older than OpenGL 4.1.
    """
    if ctx.version_code < REQUIRED_VERSION:
        renderer = ctx.info.get("GL_RENDERER", "an unnamed renderer")
        found = f"{ctx.version_code // 100}.{ctx.version_code % 100 // 10}"
        raise ContextError(f"OpenGL 4.1 is needed, {renderer} offers {found}; update the graphics driver")
    return ctx


def _create(version: int) -> moderngl.Context:
    settings: dict[str, Any] = {"standalone": True, "backend": "egl", "require": version}
    return moderngl.create_context(**settings)


def _explain(error: Exception) -> str:
    text = str(error).strip() or type(error).__name__
    if "libEGL" in text or "libGL" in text or "not loaded" in text or "not found" in text:
        return f"no OpenGL library was found ({text}); {_MISSING}"
    older = _version_without_requirement()
    if older is not None:
        return f"OpenGL 4.1 is needed, this machine offers {older}; update the graphics driver"
    return f"no off-screen OpenGL 4.1 context could be made ({text}); {_MISSING}"


def _version_without_requirement() -> str | None:
    """The version that the driver gives when asked for none, or None if it gives nothing at all."""
    try:
        ctx = _create(330)
    except Exception:  # the first error is the one worth telling
        return None
    found = f"{ctx.version_code // 100}.{ctx.version_code % 100 // 10}"
    ctx.release()
    return found
