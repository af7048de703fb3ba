"""The ground on the graphics card: heights, baked colour, edit marks."""

from __future__ import annotations

import math

import moderngl
import numpy as np
import numpy.typing as npt

from viewer.errors import TerrainDataError
from viewer.render.colouring_textures import ColouringTextures
from viewer.render.difference_texture import DifferenceTexture
from viewer.render.frame_inputs import EditOverlay, same_marks
from viewer.render.shader_library import build_program, set_uniforms
from viewer.world.heightfield import Heightfield, Rect

__all__ = ["GroundTextures", "height_texture"]

_BAKED_SIDE_MAX = 4096
_SAMPLERS = ("height", "ground_colour", "edit_mask", "detail")
_DETAIL_SIDE = 512
_DETAIL_SEED = 33
_OPENNESS_REACH = 28
"""Cells around a change whose openness may change with it (the largest radius in `bake_ground.frag`)."""
_SHADOW_REACH_MAX = 200
"""Cells that a shadow may be long, at most (the march in `bake_ground.frag`)."""


def height_texture(ctx: moderngl.Context, z: npt.NDArray[np.float32]) -> moderngl.Texture:
    """A float texture of one value a cell, row 0 first, clamped at the border and filtered linearly."""
    texture = ctx.texture((z.shape[1], z.shape[0]), 1, np.ascontiguousarray(z), dtype="f4")
    texture.repeat_x = texture.repeat_y = False
    texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
    return texture


def write_rect(texture: moderngl.Texture, values: npt.NDArray[np.generic], rect: Rect) -> None:
    """Write the part of a raster that lies in a rectangle of cells."""
    row0, col0, row1, col1 = rect
    part = np.ascontiguousarray(values[row0:row1, col0:col1])
    texture.write(part, viewport=(col0, row0, col1 - col0, row1 - row0), alignment=1)


class GroundTextures:
    """Textures that follow the heightfield, the light and the edits."""

    def __init__(self, ctx: moderngl.Context, heightfield: Heightfield) -> None:
        """Upload and bake.

        Args:
            ctx: the OpenGL context.
            heightfield: the ground, with its imagery and the cells without data as they are now.
        """
        self._ctx = ctx
        self._heightfield = heightfield
        nrows, ncols = heightfield.z_b.shape
        self.height = height_texture(ctx, heightfield.drawn)
        self._revision = heightfield.revision
        imagery, outside = heightfield.imagery, heightfield.outside
        self._imagery = None if imagery is None else _imagery_texture(ctx, imagery)
        self._outside = None if outside is None else _mask_texture(ctx, outside)
        self.mask = ctx.texture((ncols, nrows), 1, np.full((nrows, ncols), 128, dtype=np.uint8), alignment=1)
        self.mask.repeat_x = self.mask.repeat_y = False
        self._edits: EditOverlay | None = None
        self._detail = _detail_texture(ctx)
        self.difference = DifferenceTexture(ctx, (nrows, ncols))
        self.colouring = ColouringTextures(ctx, (nrows, ncols))

        scale = 1.0
        if self._imagery is not None:
            scale = max(1.0, self._imagery.width / ncols, self._imagery.height / nrows)
        elif max(nrows, ncols) <= _BAKED_SIDE_MAX // 4:
            scale = 2.0
        scale = (
            min(scale, _BAKED_SIDE_MAX / max(nrows, ncols)) if max(nrows, ncols) < _BAKED_SIDE_MAX else 1.0
        )
        self._baked_size = (max(1, round(ncols * scale)), max(1, round(nrows * scale)))
        self.colour = ctx.texture(self._baked_size, 4)
        self.colour.repeat_x = self.colour.repeat_y = False
        self.colour.build_mipmaps()
        self.colour.filter = (moderngl.LINEAR_MIPMAP_LINEAR, moderngl.LINEAR)
        self._target = ctx.framebuffer([self.colour])
        self._program = build_program(ctx, "full_screen.vert", "bake_ground.frag")
        self._array = ctx.vertex_array(self._program, [])
        self._baked_for: tuple[object, ...] | None = None
        self._elevation_range = _tinted_range(heightfield)

    def follow(
        self, sun: tuple[float, float, float], show_imagery: bool, edits: EditOverlay | None
    ) -> Rect | None:
        """Bring all textures up to date, and return the rectangle of heights that changed."""
        dirty = self._heightfield.changed_since(self._revision)
        if dirty is not None:
            write_rect(self.height, self._heightfield.drawn, dirty)
            self._revision = self._heightfield.revision
        baked_for = (sun, show_imagery)
        if self._baked_for != baked_for:
            self._bake(sun, show_imagery, (0, 0, *self._heightfield.z_b.shape))
            self._baked_for = baked_for
        elif dirty is not None:
            self._bake(sun, show_imagery, dirty)
        self._follow_edits(edits)
        return dirty

    def bind(self, program: moderngl.Program) -> None:
        """Bind what `ground.glsl`, `difference.glsl` and `water_classes.glsl` ask for, and the heights."""
        textures = (self.height, self.colour, self.mask, self._detail)
        for unit, (name, texture) in enumerate(zip(_SAMPLERS, textures, strict=True)):
            texture.use(unit)
            set_uniforms(program, **{name: unit})
        set_uniforms(program, has_edits=int(self._edits is not None))
        self.difference.bind(program)
        self.colouring.bind(program)

    def release(self) -> None:
        """Give the memory back."""
        textures = (self.colour, self.mask, self.height, self._detail, self._imagery, self._outside)
        followers = (self.difference, self.colouring)
        for thing in (self._array, self._program, self._target, *followers, *textures):
            if thing is not None:
                thing.release()

    def _bake(self, sun: tuple[float, float, float], show_imagery: bool, rect: Rect) -> None:
        nrows, ncols = self._heightfield.z_b.shape
        width, height = self._baked_size
        reach = self._light_reach(sun)
        row0, col0 = max(0, rect[0] - reach), max(0, rect[1] - reach)
        row1, col1 = min(nrows, rect[2] + reach), min(ncols, rect[3] + reach)
        x0, x1 = col0 * width // ncols, -(-col1 * width // ncols)
        y0, y1 = row0 * height // nrows, -(-row1 * height // nrows)
        has_imagery = show_imagery and self._imagery is not None
        set_uniforms(
            self._program,
            height=0,
            imagery=1,
            has_imagery=int(has_imagery),
            cells=(float(ncols), float(nrows)),
            dx=self._heightfield.grid.dx,
            sun=sun,
            elevation_range=self._elevation_range,
            outside=2,
            has_outside=int(self._outside is not None),
            window=(x0 / width, y0 / height, (x1 - x0) / width, (y1 - y0) / height),
        )
        self.height.use(0)
        if self._imagery is not None:
            self._imagery.use(1)
        if self._outside is not None:
            self._outside.use(2)
        self._target.use()
        self._target.viewport = (x0, y0, x1 - x0, y1 - y0)
        self._ctx.enable_only(moderngl.NOTHING)
        self._array.render(moderngl.TRIANGLES, vertices=3)
        self.colour.build_mipmaps()
        self.colour.filter = (moderngl.LINEAR_MIPMAP_LINEAR, moderngl.LINEAR)

    def _light_reach(self, sun: tuple[float, float, float]) -> int:
        """Cells around a change whose light may change with it: as far as the highest hill throws shadow."""
        field = self._heightfield
        slope = max(sun[1], 1e-3) / max(math.hypot(sun[0], sun[2]), 1e-3)
        shadow = 1.2 * (field.z_max - field.z_min) / (slope * field.grid.dx)
        return _OPENNESS_REACH + math.ceil(min(shadow, _SHADOW_REACH_MAX))

    def _follow_edits(self, edits: EditOverlay | None) -> None:
        if same_marks(edits, self._edits):
            return
        shape = self._heightfield.z_b.shape
        if edits is None:
            mask = np.full(shape, 128, dtype=np.uint8)
        elif edits.sign.shape == shape:
            mask = (128 + 127 * edits.sign.astype(np.int16)).astype(np.uint8)
        else:
            raise TerrainDataError(f"edit mask has shape {edits.sign.shape}, the terrain has {shape}")
        self.mask.write(mask, alignment=1)
        self._edits = edits


def _imagery_texture(ctx: moderngl.Context, imagery: npt.NDArray[np.uint8]) -> moderngl.Texture:
    texture = ctx.texture((imagery.shape[1], imagery.shape[0]), 3, np.ascontiguousarray(imagery), alignment=1)
    texture.repeat_x = texture.repeat_y = False
    texture.build_mipmaps()
    texture.filter = (moderngl.LINEAR_MIPMAP_LINEAR, moderngl.LINEAR)
    return texture


def _mask_texture(ctx: moderngl.Context, mask: npt.NDArray[np.bool_]) -> moderngl.Texture:
    pixels = np.where(mask, 255, 0).astype(np.uint8)
    texture = ctx.texture((mask.shape[1], mask.shape[0]), 1, pixels, alignment=1)
    texture.repeat_x = texture.repeat_y = False
    return texture


def _detail_texture(ctx: moderngl.Context) -> moderngl.Texture:
    """A tile of grain that repeats without a seam, has no direction and averages to one half."""
    side = _DETAIL_SIDE
    waves = np.hypot(np.fft.fftfreq(side)[:, None], np.fft.fftfreq(side)[None, :]) * side
    # Long waves would betray the tile; short ones carry less.
    strength = np.where(waves > 9.0, 1.0 / np.maximum(waves, 1.0) ** 1.3, 0.0)
    white = np.fft.fft2(np.random.default_rng(_DETAIL_SEED).normal(size=(side, side)))
    grain = np.fft.ifft2(white * strength).real
    pixels = np.clip(127.5 + 42.0 * (grain - grain.mean()) / grain.std(), 0, 255).astype(np.uint8)
    texture = ctx.texture((side, side), 1, pixels, alignment=1)
    texture.build_mipmaps()
    texture.filter = (moderngl.LINEAR_MIPMAP_NEAREST, moderngl.LINEAR)
    return texture


def _tinted_range(field: Heightfield) -> tuple[float, float]:
    """Lowest and highest ground to tint [m]."""
    z = field.z_b if field.outside is None else field.z_b[~field.outside]
    low, high = np.percentile(z.ravel()[:: max(1, z.size // 200_000)], (0.5, 99.5))
    return float(low), float(high)
