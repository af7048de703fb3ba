"""The off-screen target of the scene: colour and depth, with or without multisampling."""

from __future__ import annotations

import moderngl

__all__ = ["RenderTarget"]


class RenderTarget:
    """Colour and depth of one size.

    The scene never goes straight into the window: its depth must be readable for picking, and a window's own
    framebuffer may be multisampled in a way that is not ours to choose.
    """

    def __init__(self, ctx: moderngl.Context, size: tuple[int, int], samples: int) -> None:
        """Allocate.

        Args:
            ctx: the OpenGL context.
            size: width and height [pixels].
            samples: 0 for none, else samples a pixel.
        """
        self._ctx = ctx
        self.size = size
        self.samples = samples
        self.colour = ctx.texture(size, 4)
        self.colour.repeat_x = self.colour.repeat_y = False
        self._depth = ctx.depth_renderbuffer(size)
        self._resolved = ctx.framebuffer([self.colour], self._depth)
        self._multisampled: moderngl.Framebuffer | None = None
        if samples:
            colour = ctx.renderbuffer(size, 4, samples=samples)
            self._multisampled = ctx.framebuffer([colour], ctx.depth_renderbuffer(size, samples=samples))

    @property
    def framebuffer(self) -> moderngl.Framebuffer:
        """What the passes draw into."""
        return self._resolved if self._multisampled is None else self._multisampled

    def resolve(self) -> None:
        """Bring colour and depth of a multisampled picture to where they can be read."""
        if self._multisampled is not None:
            self._ctx.copy_framebuffer(self._resolved, self._multisampled)

    def depth_at(self, x: int, y: int) -> float:
        """Depth of one pixel, 0 to 1, counted from the lower left."""
        raw = self._resolved.read(viewport=(x, y, 1, 1), components=1, attachment=-1, dtype="f4")
        return float(memoryview(raw).cast("f")[0])

    def read_depth(self) -> bytes:
        """All depths as float32, lowest row first."""
        return bytes(self._resolved.read(components=1, attachment=-1, dtype="f4"))

    def release(self) -> None:
        """Give the memory back."""
        for framebuffer in (self._multisampled, self._resolved):
            if framebuffer is not None:
                for attachment in framebuffer.color_attachments:
                    attachment.release()
                if framebuffer.depth_attachment is not None:
                    framebuffer.depth_attachment.release()
                framebuffer.release()
