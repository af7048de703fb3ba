"""The renderer: a context, a target, a size and `FrameInputs` in, a picture out. It knows no window toolkit."""

from __future__ import annotations

import math
from time import perf_counter

import moderngl
import numpy as np
import numpy.typing as npt

from viewer.lod import BlockTiling, Selection
from viewer.render.block_mesh import BlockIndices
from viewer.render.context import check_context
from viewer.render.frame_inputs import FrameInputs, FrameStats
from viewer.render.frame_uniforms import FrameUniforms, sun_direction
from viewer.render.ground_textures import GroundTextures
from viewer.render.present_pass import PresentPass
from viewer.render.render_target import RenderTarget
from viewer.render.terrain_lod import TerrainLod
from viewer.render.terrain_pass import TerrainPass
from viewer.world.camera import Camera
from viewer.world.coordinates import Point
from viewer.world.heightfield import Heightfield

__all__ = ["Renderer"]


class Renderer:
    """Draws one terrain and its flood.

    Use it with the OpenGL context current, always from the same thread. Change the ground by `heightfield.set`;
    the renderer notices.
    """

    def __init__(
        self,
        ctx: moderngl.Context,
        heightfield: Heightfield,
        imagery: npt.NDArray[np.uint8] | None = None,
        block_size: int = 33,
    ) -> None:
        """Upload the terrain and compile the shaders.

        Args:
            ctx: an OpenGL 4.1 core context.
            heightfield: the ground; watched for changes.
            imagery: optional picture of the ground, [rows, cols, 3] uint8, row 0 in the south, covering the grid.
            block_size: vertices along a block's side: 17, 33 or 65.

        Raises:
            ContextError: if the context is older than OpenGL 4.1.
            ShaderError: if a shader does not compile.
            TerrainDataError: if the imagery is not 8-bit RGB.
        """
        self._ctx = check_context(ctx)
        self._heightfield = heightfield
        shape = heightfield.z_b.shape
        tiling = BlockTiling(shape[0], shape[1], block_size)
        self._lod = TerrainLod(heightfield, tiling)
        self._ground = GroundTextures(ctx, heightfield, imagery)
        self._indices = BlockIndices(ctx, block_size, tiling.level_count)
        self._uniforms = FrameUniforms(ctx, (shape[0], shape[1]), tiling.stride, heightfield.grid.dx)
        self._terrain = TerrainPass(ctx, tiling, self._indices)
        self._present = PresentPass(ctx)
        self._target: RenderTarget | None = None
        self._inverse: npt.NDArray[np.float64] | None = None
        self._frame = heightfield.frame

    def draw(self, target: moderngl.Framebuffer, size: tuple[int, int], inputs: FrameInputs) -> FrameStats:
        """Draw one picture.

        Args:
            target: framebuffer to end in, say a window's default one.
            size: its width and height [pixels].
            inputs: everything the picture depends on.

        Returns:
            what it cost.
        """
        begun = perf_counter()
        options = inputs.options
        scene = self._scene_target(size, options.samples)
        self._frame = self._heightfield.frame.exaggerated(options.exaggeration)
        sun = sun_direction(options.light_azimuth_deg, options.light_elevation_deg)
        dirty = self._ground.follow(sun, options.show_imagery, inputs.edits)
        if dirty is not None:
            self._lod.refresh(dirty)

        selecting = perf_counter()
        selection = self._lod.select(inputs, self._frame, size, None, 0.0)
        selected = perf_counter()

        near, far = self._clip_planes(inputs.camera, size, selection)
        view_projection = inputs.camera.projection(size[0] / size[1], near, far) @ inputs.camera.view_matrix()
        self._inverse = np.linalg.inv(view_projection)
        self._uniforms.write(inputs, self._frame, view_projection, size, self._heightfield.z_min)

        scene.framebuffer.use()
        scene.framebuffer.viewport = (0, 0, *size)
        scene.framebuffer.clear(*options.background, 1.0)
        draws = self._terrain.draw(self._ground, selection.terrain, options) if options.show_terrain else 0
        scene.resolve()
        self._present.draw(target, size, scene.colour, None)
        done = perf_counter()
        stats = selection.stats
        return FrameStats(
            terrain_triangles=stats.terrain_triangles if options.show_terrain else 0,
            water_triangles=stats.water_triangles,
            terrain_blocks=stats.terrain_blocks,
            water_blocks=stats.water_blocks,
            culled_blocks=stats.culled_blocks,
            covered_blocks=stats.covered_blocks,
            draws=draws + 1,
            near=near,
            far=far,
            selection_ms=1e3 * (selected - selecting),
            submission_ms=1e3 * (done - begun - (selected - selecting)),
        )

    def pick(self, x: float, y: float) -> Point | None:
        """The place under a pixel of the last picture, by reading its depth.

        Args:
            x: from the left [pixels].
            y: from the top [pixels].

        Returns:
            grid coordinates and elevation (x, y, z) [m, datum-relative], or None where there is only sky.
        """
        if self._target is None or self._inverse is None:
            return None
        width, height = self._target.size
        column, row = math.floor(x), height - 1 - math.floor(y)
        if not (0 <= column < width and 0 <= row < height):
            return None
        depth = self._target.depth_at(column, row)
        if depth >= 1.0:
            return None
        ndc = np.array(
            [2.0 * (column + 0.5) / width - 1.0, 2.0 * (row + 0.5) / height - 1.0, 2.0 * depth - 1.0, 1.0]
        )
        world = self._inverse @ ndc
        world = world[:3] / world[3]
        return self._frame.from_world((float(world[0]), float(world[1]), float(world[2])))

    def read_pixels(self, framebuffer: moderngl.Framebuffer, size: tuple[int, int]) -> npt.NDArray[np.uint8]:
        """The colours of a framebuffer, shape [height, width, 3], first row on top."""
        raw = framebuffer.read(viewport=(0, 0, *size), components=3, alignment=1)
        return np.frombuffer(raw, dtype=np.uint8).reshape(size[1], size[0], 3)[::-1].copy()

    def release(self) -> None:
        """Give all graphics memory back."""
        for thing in (
            self._terrain,
            self._present,
            self._ground,
            self._indices,
            self._uniforms,
            self._target,
        ):
            if thing is not None:
                thing.release()
        self._target = None

    def _scene_target(self, size: tuple[int, int], samples: int) -> RenderTarget:
        target = self._target
        if target is None or target.size != size or target.samples != samples:
            if target is not None:
                target.release()
            self._target = target = RenderTarget(self._ctx, size, samples)
        return target

    def _clip_planes(
        self, camera: Camera, size: tuple[int, int], selection: Selection
    ) -> tuple[float, float]:
        """As tight as the boxes in view allow: 24 bits of depth are few for a flood seen from far."""
        tan_y = math.tan(0.5 * camera.fov_y)
        corner = math.sqrt(1.0 + tan_y * tan_y * (1.0 + (size[0] / size[1]) ** 2))
        ground = float(self._heightfield.world_height(camera.eye[0], camera.eye[2], self._frame))
        above = max(float(camera.eye[1]) - ground, 0.0)
        near = max(0.9 * selection.distance_min / corner, 0.25 * above, 0.5)
        near = min(near, 1e5)
        return near, max(1.1 * selection.distance_max, 2.0 * near)
