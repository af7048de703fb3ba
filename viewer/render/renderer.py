"""The renderer.

A context, a target, a size and `FrameInputs` in, a picture out. It knows no window toolkit.
"""

from __future__ import annotations

import math
from time import perf_counter

import moderngl
import numpy as np
import numpy.typing as npt

from viewer.lod import Selection
from viewer.render.block_passes import BlockPasses
from viewer.render.context import check_context
from viewer.render.flow_pass import FlowPass
from viewer.render.frame_inputs import FrameInputs, FrameStats, RenderOptions, WaterPair
from viewer.render.frame_uniforms import sun_direction
from viewer.render.ground_textures import GroundTextures
from viewer.render.hud_pass import HudPass
from viewer.render.line_pass import LinePass
from viewer.render.picking import Unprojection
from viewer.render.present_pass import PresentPass
from viewer.render.render_target import RenderTarget
from viewer.render.sky import SkyPass
from viewer.render.water_textures import WaterSlot, combined_states
from viewer.world.camera import Camera
from viewer.world.coordinates import Point, WorldFrame
from viewer.world.flow_arrows import Arrows, FlowField, flow_arrows
from viewer.world.heightfield import Heightfield

__all__ = ["Renderer"]

WHOLE = (0.0, 1.0)
_SKIRT_SHARE = 0.012
"""Height of the map's walls below the lowest ground, as a share of the map's longer side."""


class Renderer:
    """Draws one terrain and its flood.

    Use it with the OpenGL context current, always from the same thread. Change the ground by
    `heightfield.set`; the renderer notices.
    """

    def __init__(self, ctx: moderngl.Context, heightfield: Heightfield) -> None:
        """Upload the terrain and compile the shaders.

        Args:
            ctx: an OpenGL 4.1 core context.
            heightfield: the ground; its bed is watched for changes.

        Raises:
            ContextError: if the context is older than OpenGL 4.1.
            ShaderError: if a shader does not compile.
        """
        self._ctx = check_context(ctx)
        self._heightfield = heightfield
        self._ground = GroundTextures(ctx, heightfield)
        self._blocks = BlockPasses(ctx, heightfield, RenderOptions.block_size, RenderOptions.border)
        self._lines = LinePass(ctx, heightfield)
        self._sky = SkyPass(ctx)
        self._flow = FlowPass(ctx)
        self._present = PresentPass(ctx)
        self._hud = HudPass(ctx)
        map_size = max(heightfield.z_b.shape) * heightfield.grid.dx
        self._skirt_foot = heightfield.z_min - _SKIRT_SHARE * map_size
        self._target: RenderTarget | None = None
        self._picture_size = (1, 1)
        self._unprojection: Unprojection | None = None

    def draw(
        self,
        target: moderngl.Framebuffer,
        size: tuple[int, int],
        inputs: FrameInputs,
        part: tuple[float, float] = WHOLE,
    ) -> FrameStats:
        """Draw one picture.

        Args:
            target: framebuffer to end in, say a window's default one.
            size: its width and height [pixels].
            inputs: everything the picture depends on.
            part: from which share of the width to which to draw; the rest of the target stays as it is.

        Returns:
            what it cost.

        Raises:
            TerrainDataError: if an array does not fit the terrain.
        """
        begun = perf_counter()
        options = inputs.options
        blocks = self._blocks_of(options)
        scene = self._scene_target(_scaled(size, options.render_scale), options.samples)
        frame = self._heightfield.frame.exaggerated(options.exaggeration)
        sun = sun_direction(options.light_azimuth_deg, options.light_elevation_deg)
        dirty = self._ground.follow(sun, options.show_imagery, inputs.edits)
        if dirty is not None:
            blocks.lod.refresh(dirty)
        self._ground.difference.follow(inputs.difference)
        self._ground.colouring.follow(inputs.colouring)
        blocks.lod.follow_edits(inputs.edits)
        self._sky.follow(sun)
        water = inputs.water if options.show_water else None
        slots = None if water is None else blocks.water_textures.follow(water)

        selecting = perf_counter()
        states, depth_max = (None, 0.0) if slots is None else combined_states(*slots)
        selection = blocks.lod.select(inputs, frame, scene.size, states, depth_max)
        selected = perf_counter()

        near, far = self._clip_planes(inputs.camera, frame, size, selection)
        view = inputs.camera.view_matrix()
        projection = inputs.camera.projection(size[0] / size[1], near, far)
        self._unprojection = Unprojection(
            np.asarray(np.linalg.inv(projection @ view), dtype=np.float64), scene.size, frame
        )
        blocks.uniforms.write(inputs, frame, projection @ view, scene.size, self._skirt_foot)
        scene.framebuffer.scissor = _columns(scene.size, part)  # type: ignore[assignment]
        draws = self._draw_scene(scene, inputs, selection, slots, projection, view)
        scene.resolve()
        self._picture_size = size
        draws += self._present.draw(target, size, scene.colour, inputs.is_outdated, _columns(size, part))
        draws += self._hud.draw(target, size, inputs)
        done = perf_counter()
        stats = selection.stats
        return FrameStats(
            terrain_triangles=stats.terrain_triangles if options.show_terrain else 0,
            water_triangles=stats.water_triangles,
            terrain_blocks=stats.terrain_blocks if options.show_terrain else 0,
            water_blocks=stats.water_blocks,
            culled_blocks=stats.culled_blocks,
            covered_blocks=stats.covered_blocks,
            draws=draws,
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
            grid coordinates and elevation (x, y, z) [m, datum-relative] on whatever is drawn there, ground or
            water; None where there is only sky.
        """
        if self._target is None or self._unprojection is None:
            return None
        width, height = self._target.size
        column = math.floor((math.floor(x) + 0.5) * width / self._picture_size[0])
        row = height - 1 - math.floor((math.floor(y) + 0.5) * height / self._picture_size[1])
        if not (0 <= column < width and 0 <= row < height):
            return None
        depth = self._target.depth_at(column, row)
        return None if depth >= 1.0 else self._unprojection.place(column, row, depth)

    def read_depth(self) -> tuple[npt.NDArray[np.float32], Unprojection]:
        """Depths of the last picture and the way back from them to the world.

        Returns:
            depths (0 to 1), shape [height, width], lowest row first; and the unprojection.

        Raises:
            RuntimeError: before the first picture.
        """
        if self._target is None or self._unprojection is None:
            raise RuntimeError("no picture has been drawn yet")
        width, height = self._target.size
        depth = np.frombuffer(self._target.read_depth(), dtype="<f4").reshape(height, width)
        return depth, self._unprojection

    @staticmethod
    def read_pixels(framebuffer: moderngl.Framebuffer, size: tuple[int, int]) -> npt.NDArray[np.uint8]:
        """The colours of a framebuffer, shape [height, width, 3], first row on top."""
        raw = framebuffer.read(viewport=(0, 0, *size), components=3, alignment=1)
        return np.frombuffer(raw, dtype=np.uint8).reshape(size[1], size[0], 3)[::-1].copy()

    def release(self) -> None:
        """Give all graphics memory back."""
        passes = (self._blocks, self._lines, self._flow, self._sky, self._present, self._hud)
        for thing in (*passes, self._ground):
            thing.release()
        if self._target is not None:
            self._target.release()
        self._target = None

    def _draw_scene(
        self,
        scene: RenderTarget,
        inputs: FrameInputs,
        selection: Selection,
        slots: tuple[WaterSlot, WaterSlot] | None,
        projection: npt.NDArray[np.float64],
        view: npt.NDArray[np.float64],
    ) -> int:
        options, blocks = inputs.options, self._blocks
        scene.framebuffer.use()
        scene.framebuffer.viewport = (0, 0, *scene.size)
        scene.framebuffer.clear(*options.background, 1.0)
        draws = 0
        # Front to back: water hides ground, ground hides sky, and what is hidden is not shaded.
        if slots is not None and inputs.water is not None:
            alpha = inputs.water.alpha
            draws += blocks.water.draw(
                self._ground, slots, alpha, self._sky.texture, selection.water, options
            )
            if options.show_skirt:
                draws += blocks.skirt.draw(self._ground, selection, slots, alpha)
        if options.show_terrain:
            draws += blocks.terrain.draw(self._ground, selection.terrain, options)
        if options.show_skirt:
            draws += blocks.skirt.draw(self._ground, selection)
        if options.show_sky:
            rotation = view.copy()
            rotation[:3, 3] = 0.0
            draws += self._sky.draw(np.asarray(np.linalg.inv(projection @ rotation), dtype=np.float64))
        if inputs.flow is not None and inputs.water is not None and slots is not None:
            arrows = self._arrows(inputs, inputs.water, inputs.flow, scene.size)
            draws += self._flow.draw(self._ground, slots, inputs.water.alpha, arrows)
        lines = inputs.lines if inputs.edits is None else (*inputs.lines, *inputs.edits.lines)
        if lines or inputs.edits is not None:
            alpha = 0.0 if inputs.water is None else inputs.water.alpha
            draws += self._lines.draw(self._ground, lines, slots, alpha, options.render_scale)
        return draws

    def _blocks_of(self, options: RenderOptions) -> BlockPasses:
        """The passes for the blocks asked for, made anew when they are others than before."""
        tiling = self._blocks.tiling
        if (tiling.block_size, tiling.border) != (options.block_size, options.border):
            self._blocks.release()
            self._blocks = BlockPasses(self._ctx, self._heightfield, options.block_size, options.border)
        return self._blocks

    def _arrows(
        self, inputs: FrameInputs, water: WaterPair, flow: FlowField, size: tuple[int, int]
    ) -> Arrows:
        frame = self._heightfield.frame.exaggerated(inputs.options.exaggeration)
        depths = water.first.h, water.second.h
        aspect = size[0] / size[1]
        return flow_arrows(inputs.camera, aspect, self._heightfield, frame, depths, flow, water.alpha)

    def _scene_target(self, size: tuple[int, int], samples: int) -> RenderTarget:
        target = self._target
        if target is None or target.size != size or target.samples != samples:
            if target is not None:
                target.release()
            self._target = target = RenderTarget(self._ctx, size, samples)
        return target

    def _clip_planes(
        self, camera: Camera, frame: WorldFrame, size: tuple[int, int], selection: Selection
    ) -> tuple[float, float]:
        """As tight as the boxes in view allow: 24 bits of depth are few for a flood seen from far."""
        tan_y = math.tan(0.5 * camera.fov_y)
        corner = math.sqrt(1.0 + tan_y * tan_y * (1.0 + (size[0] / size[1]) ** 2))
        ground = float(self._heightfield.world_height(camera.eye[0], camera.eye[2], frame))
        above = max(float(camera.eye[1]) - ground, 0.0)
        near = max(0.9 * selection.distance_min / corner, 0.25 * above, 0.5)
        near = min(near, 1e5)
        # The walls of the map reach below the boxes.
        return near, max(1.2 * selection.distance_max, 2.0 * near)


def _columns(size: tuple[int, int], part: tuple[float, float]) -> tuple[int, int, int, int] | None:
    """The rectangle of a part of the width, from the lower left; None for all of it."""
    if part == WHOLE:
        return None
    first, end = (round(size[0] * share) for share in part)
    return first, 0, end - first, size[1]


def _scaled(size: tuple[int, int], scale: float) -> tuple[int, int]:
    return (max(1, round(size[0] * scale)), max(1, round(size[1] * scale)))
