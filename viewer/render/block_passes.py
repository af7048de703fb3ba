"""Everything on the graphics card that depends on how the terrain is cut into blocks."""

from __future__ import annotations

import moderngl

from viewer.lod import BlockTiling, Border
from viewer.render.block_mesh import BlockIndices
from viewer.render.frame_uniforms import FrameUniforms
from viewer.render.skirt_pass import SkirtPass
from viewer.render.terrain_lod import TerrainLod
from viewer.render.terrain_pass import TerrainPass
from viewer.render.water_pass import WaterPass
from viewer.render.water_textures import WaterTextures
from viewer.world.heightfield import Heightfield

__all__ = ["BlockPasses"]


class BlockPasses:
    """The passes that draw blocks of one size, with what they share.

    Attributes:
        tiling: the blocks.
        lod: their levels of detail.
        uniforms: the uniform block of a picture.
        terrain: draws the ground.
        water_textures: the frames of the flood.
        water: draws the flood.
        skirt: draws the walls of the map.
    """

    def __init__(
        self, ctx: moderngl.Context, heightfield: Heightfield, block_size: int, border: Border
    ) -> None:
        """Compute the errors of all blocks, compile and allocate.

        Args:
            ctx: the OpenGL context.
            heightfield: the ground.
            block_size: vertices along a block's side: 17, 33 or 65.
            border: what is done with rows and columns that fill no whole block.
        """
        grid = heightfield.grid
        self.tiling = BlockTiling(grid.nrows, grid.ncols, block_size, border)
        self.lod = TerrainLod(heightfield, self.tiling)
        self._indices = BlockIndices(ctx, block_size, self.tiling.level_count)
        self.uniforms = FrameUniforms(ctx, self.tiling, grid.dx)
        self.terrain = TerrainPass(ctx, self.tiling, self._indices)
        self.water_textures = WaterTextures(ctx, self.tiling, grid.dx, heightfield.z_b)
        self.water = WaterPass(ctx, self.tiling, self._indices)
        self.skirt = SkirtPass(ctx, self.tiling)

    def release(self) -> None:
        """Give the memory back."""
        passes = (self.terrain, self.water, self.skirt)
        for thing in (*passes, self.water_textures, self._indices, self.uniforms):
            thing.release()
