"""Draws the flood.

The surface over partial and wet blocks, with what it mirrors and what is seen through it.
"""

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
from viewer.render.water_textures import WaterSlot, bind_slots

__all__ = ["WaterPass", "ripple_slopes"]

_OWN_UNITS = {"sky": 4, "ripples": 5, "slope_first": 6, "slope_second": 7}
"""Texture units after those of the ground."""
_WATER_UNIT = 8
_RIPPLE_SIDE = 256
_SEED = 2011


def ripple_slopes(side: int = _RIPPLE_SIDE) -> npt.NDArray[np.uint8]:
    """Slopes of a small, tileable sea, 128 for level, shape [side, side, 2].

    A sum of plane waves with whole numbers of wave lengths along the tile, so that it repeats without a seam.
    """
    rng = np.random.default_rng(_SEED)
    at = np.arange(side) * (2.0 * np.pi / side)
    slopes = np.zeros((side, side, 2))
    for _ in range(48):
        k, bearing, phase = rng.integers(2, 15), rng.normal(0.6, 0.9), rng.uniform(0.0, 2.0 * np.pi)
        kx, kz = round(k * np.cos(bearing)), round(k * np.sin(bearing))
        wave = np.cos(kx * at[None, :] + kz * at[:, None] + phase) / (1.0 + 0.15 * k)
        slopes += wave[..., None] * np.array([kx, kz]) / max(np.hypot(kx, kz), 1.0)
    slopes /= np.abs(slopes).max()
    return np.clip(128.0 + 127.0 * slopes, 0, 255).astype(np.uint8)


class WaterPass:
    """The water surface."""

    def __init__(self, ctx: moderngl.Context, tiling: BlockTiling, indices: BlockIndices) -> None:
        """Compile and allocate."""
        self._ctx = ctx
        self._program = build_program(ctx, "water.vert", "water.frag")
        set_uniforms(self._program, **_OWN_UNITS)
        self._blocks = BlockInstances(ctx, self._program, indices, tiling.block_count)
        self._ripples = ctx.texture((_RIPPLE_SIDE, _RIPPLE_SIDE), 2, ripple_slopes())
        self._ripples.build_mipmaps()
        self._ripples.filter = (moderngl.LINEAR_MIPMAP_NEAREST, moderngl.LINEAR)

    def draw(
        self,
        ground: GroundTextures,
        slots: tuple[WaterSlot, WaterSlot],
        alpha: float,
        sky: moderngl.TextureCube,
        by_level: Sequence[npt.NDArray[np.void]],
        options: RenderOptions,
    ) -> int:
        """Draw the selected blocks, and return the number of draws."""
        ground.bind(self._program)
        sky.use(_OWN_UNITS["sky"])
        self._ripples.use(_OWN_UNITS["ripples"])
        slots[0].slope.use(_OWN_UNITS["slope_first"])
        slots[1].slope.use(_OWN_UNITS["slope_second"])
        bind_slots(self._program, slots, alpha, _WATER_UNIT)
        self._ctx.enable_only(moderngl.DEPTH_TEST)
        self._ctx.depth_func = "<="
        self._ctx.wireframe = options.wireframe
        set_uniforms(self._program, snap_edges=int(options.snap_edges))
        draws = self._blocks.draw(by_level)
        self._ctx.wireframe = False
        return draws

    def release(self) -> None:
        """Give the memory back."""
        self._blocks.release()
        self._ripples.release()
        self._program.release()
