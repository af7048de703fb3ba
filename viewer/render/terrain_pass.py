"""Draws the ground: geomipmapped blocks, one instanced draw a level, edges fitted in the vertex shader."""

from __future__ import annotations

from collections.abc import Sequence

import moderngl
import numpy as np
import numpy.typing as npt

from viewer.lod.block_tiling import BlockTiling
from viewer.render.block_mesh import BlockIndices, BlockInstances
from viewer.render.frame_inputs import RenderOptions
from viewer.render.ground_textures import GroundTextures
from viewer.render.shader_library import build_program, set_uniforms

__all__ = ["TerrainPass"]


class TerrainPass:
    """The ground."""

    def __init__(self, ctx: moderngl.Context, tiling: BlockTiling, indices: BlockIndices) -> None:
        """Compile and allocate."""
        self._ctx = ctx
        self._program = build_program(ctx, "terrain.vert", "terrain.frag")
        self._blocks = BlockInstances(ctx, self._program, indices, tiling.block_count)

    def draw(
        self, ground: GroundTextures, by_level: Sequence[npt.NDArray[np.void]], options: RenderOptions
    ) -> int:
        """Draw the selected blocks, and return the number of draws."""
        ctx = self._ctx
        ctx.enable_only(moderngl.DEPTH_TEST)
        ctx.depth_func = "<="
        # The ground steps back a hair, so that water lying on it wins.
        ctx.polygon_offset = (0.0, 2.0)
        ctx.wireframe = options.wireframe
        ground.bind(self._program)
        set_uniforms(self._program, snap_edges=int(options.snap_edges))
        draws = self._blocks.draw(by_level)
        ctx.wireframe = False
        ctx.polygon_offset = (0.0, 0.0)
        return draws

    def release(self) -> None:
        """Give the memory back."""
        self._blocks.release()
        self._program.release()
