"""Draws arrows of the flow on the water: a dark rim, and the arrow over it."""

from __future__ import annotations

import moderngl

from viewer.render.ground_textures import GroundTextures
from viewer.render.shader_library import build_program, set_uniforms
from viewer.render.water_textures import WaterSlot, bind_slots
from viewer.world.flow_arrows import Arrows

__all__ = ["FlowPass"]

_VERTICES = 9
_RIM = 0.13
"""Width of the dark rim, in widths of the arrow."""
_DARK, _LIGHT = (0.04, 0.07, 0.12, 0.85), (1.0, 1.0, 1.0, 1.0)


class FlowPass:
    """The arrows."""

    def __init__(self, ctx: moderngl.Context) -> None:
        """Compile."""
        self._ctx = ctx
        self._program = build_program(ctx, "flow.vert", "flow.frag")
        self._buffer = ctx.buffer(reserve=4096, dynamic=True)
        self._array = self._new_array()

    def draw(
        self, ground: GroundTextures, slots: tuple[WaterSlot, WaterSlot], alpha: float, arrows: Arrows
    ) -> int:
        """Draw arrows, and return the number of draws."""
        count = len(arrows.records)
        if not count:
            return 0
        if arrows.records.nbytes > self._buffer.size:
            self._array.release()
            self._buffer.release()
            self._buffer = self._ctx.buffer(reserve=2 * arrows.records.nbytes, dynamic=True)
            self._array = self._new_array()
        self._buffer.orphan()
        self._buffer.write(arrows.records)
        ground.height.use(0)
        bind_slots(self._program, slots, alpha, unit=1)
        self._ctx.enable_only(moderngl.DEPTH_TEST | moderngl.BLEND)
        self._ctx.blend_func = moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA
        for rim, tint in ((_RIM, _DARK), (0.0, _LIGHT)):
            set_uniforms(self._program, rim=rim, tint=tint)
            self._array.render(moderngl.TRIANGLES, vertices=_VERTICES, instances=count)
        return 2

    def release(self) -> None:
        """Give the memory back."""
        for thing in (self._array, self._buffer, self._program):
            thing.release()

    def _new_array(self) -> moderngl.VertexArray:
        return self._ctx.vertex_array(
            self._program, [(self._buffer, "2f 2f 1f /i", "in_place", "in_along", "in_width")]
        )
