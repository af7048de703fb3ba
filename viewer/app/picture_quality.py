"""How much a picture may cost: less where OpenGL runs on the processor, more for pictures that are kept."""

from __future__ import annotations

import dataclasses

import moderngl

from viewer.render import RenderOptions

__all__ = ["interactive", "is_software", "still"]

_SOFTWARE_RENDERERS = ("llvmpipe", "softpipe", "swrast", "swiftshader", "software rasterizer")

SOFTWARE_TAU_PX = 3.0
"""Least screen error of the ground on a software renderer [pixels]."""
SOFTWARE_SPACING_PX = 2.0
"""Least spacing of water vertices on a software renderer [pixels]."""
SOFTWARE_SCALE = 0.75
STILL_SCALE = 2.0
"""Pixels of the scene for each pixel of the picture, along one side."""


def is_software(context: moderngl.Context) -> bool:
    """Whether pictures of this context are drawn by the processor."""
    name = str(context.info["GL_RENDERER"]).lower()
    return any(part in name for part in _SOFTWARE_RENDERERS)


def interactive(options: RenderOptions, scale: float = SOFTWARE_SCALE) -> RenderOptions:
    """Options for a window on a software renderer: about half the cost, a little less sharp.

    Args:
        options: what the user chose.
        scale: pixels of the scene for each pixel of the picture, at most.
    """
    return dataclasses.replace(
        options,
        tau_px=max(options.tau_px, SOFTWARE_TAU_PX),
        water_spacing_px=max(options.water_spacing_px, SOFTWARE_SPACING_PX),
        partial_spacing_px=max(options.partial_spacing_px, SOFTWARE_SPACING_PX),
        render_scale=min(options.render_scale, scale),
    )


def still(options: RenderOptions) -> RenderOptions:
    """Options for a picture that is kept: smooth edges."""
    return dataclasses.replace(options, render_scale=max(options.render_scale, STILL_SCALE))
