"""Draws the walls along the border of the map, so that the ground looks solid and the water has a side."""

from __future__ import annotations

import moderngl
import numpy as np

from viewer.lod import Selection
from viewer.lod.block_tiling import BlockTiling
from viewer.render.ground_textures import GroundTextures
from viewer.render.shader_library import build_program, set_uniforms
from viewer.render.water_textures import WaterSlot, bind_slots

__all__ = ["SkirtPass"]

_SIDE_DTYPE = np.dtype([("col", "<u2"), ("row", "<u2"), ("side", "<u2"), ("level", "<u2")])


class SkirtPass:
    """The walls of the map."""

    def __init__(self, ctx: moderngl.Context, tiling: BlockTiling) -> None:
        """Compile and allocate."""
        self._ctx = ctx
        self._stride = tiling.stride
        self._program = build_program(ctx, "skirt.vert", "skirt.frag")
        self._columns = tiling.block_cols
        rows, cols = np.divmod(np.arange(tiling.block_count), tiling.block_cols)
        borders = (cols == 0, cols == tiling.block_cols - 1, rows == 0, rows == tiling.block_rows - 1)
        parts = []
        for side, on_border in enumerate(borders):
            part = np.zeros(int(on_border.sum()), dtype=_SIDE_DTYPE)
            part["col"], part["row"], part["side"] = cols[on_border], rows[on_border], side
            parts.append(part)
        self._sides = np.concatenate(parts)
        self._block = self._sides["row"].astype(np.int64) * tiling.block_cols + self._sides["col"]
        self._buffer = ctx.buffer(reserve=self._sides.nbytes, dynamic=True)
        self._array = ctx.vertex_array(self._program, [(self._buffer, "2u2 2u2 /i", "in_block", "in_side")])

    def draw(
        self,
        ground: GroundTextures,
        selection: Selection,
        slots: tuple[WaterSlot, WaterSlot] | None = None,
        alpha: float = 0.0,
    ) -> int:
        """Draw walls of earth, or of water if slots are given, and return the number of draws."""
        sides = self._sides[selection.visible[self._block]]
        if not sides.size:
            return 0
        sides["level"] = selection.level[sides["row"].astype(np.int64) * self._columns + sides["col"]]
        self._buffer.orphan(self._sides.nbytes)
        self._buffer.write(sides)
        self._ctx.enable_only(moderngl.DEPTH_TEST)
        ground.height.use(0)
        if slots is not None:
            bind_slots(self._program, slots, alpha, unit=1)
        set_uniforms(self._program, of_water=int(slots is not None))
        self._array.render(moderngl.TRIANGLE_STRIP, vertices=2 * (self._stride + 1), instances=sides.size)
        return 1

    def release(self) -> None:
        """Give the memory back."""
        for thing in (self._array, self._buffer, self._program):
            thing.release()
