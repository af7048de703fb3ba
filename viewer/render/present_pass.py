"""The last pass: puts the finished scene into the target by a triangle.

A triangle and not a blit, because a window's framebuffer need not be one that can be blitted into.
"""

from __future__ import annotations

import moderngl

from viewer.render.shader_library import build_program, set_uniforms

__all__ = ["PresentPass"]


class PresentPass:
    """Scene into the target."""

    def __init__(self, ctx: moderngl.Context) -> None:
        """Compile."""
        self._ctx = ctx
        self._program = build_program(ctx, "full_screen.vert", "present.frag")
        set_uniforms(self._program, scene=0)
        self._array = ctx.vertex_array(self._program, [])

    def draw(
        self,
        target: moderngl.Framebuffer,
        size: tuple[int, int],
        scene: moderngl.Texture,
        is_outdated: bool = False,
        columns: tuple[int, int, int, int] | None = None,
    ) -> int:
        """Draw, and return the number of draws.

        Args:
            target: the framebuffer to end in.
            size: its size now [pixels]; a window's framebuffer object may remember an older one.
            scene: the finished scene.
            is_outdated: draw it in grey.
            columns: rectangle to draw in: left, lower, width, height [pixels]; None for all.
        """
        target.use()
        target.viewport = (0, 0, *size)
        self._ctx.enable_only(moderngl.NOTHING)
        scene.use(0)
        set_uniforms(self._program, outdated=is_outdated)
        self._ctx.scissor = columns
        self._array.render(moderngl.TRIANGLES, vertices=3)
        self._ctx.scissor = None
        return 1

    def release(self) -> None:
        """Give the memory back."""
        self._array.release()
        self._program.release()
