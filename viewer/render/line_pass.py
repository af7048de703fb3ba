"""Draws lines laid on the ground: the edit being drawn, and those that stand."""

from __future__ import annotations

from itertools import pairwise

import moderngl
import numpy as np
import numpy.typing as npt

from viewer.render.frame_inputs import DrapedLine, LineStyle
from viewer.render.ground_textures import GroundTextures
from viewer.render.shader_library import build_program, set_uniforms
from viewer.render.water_textures import WaterSlot, bind_slots
from viewer.world.heightfield import Heightfield

__all__ = ["LinePass", "drape"]

_COLOURS = {
    LineStyle.RAISE: (1.0, 0.72, 0.30, 1.0),
    LineStyle.LOWER: (0.55, 0.75, 1.0, 1.0),
    LineStyle.DRAFT: (1.0, 1.0, 1.0, 1.0),
    LineStyle.MEASURE: (1.0, 0.45, 0.85, 1.0),
    LineStyle.SECTION: (0.35, 0.95, 0.80, 1.0),
    LineStyle.SELECTED: (1.0, 1.0, 0.35, 1.0),
}
_WIDTH_PX = 5.0
_RING_POINTS = 33


def drape(heightfield: Heightfield, vertices: tuple[tuple[float, float], ...]) -> npt.NDArray[np.float64]:
    """Points along a polyline, at least one a half cell.

    Args:
        heightfield: the ground.
        vertices: grid coordinates [m].

    Returns:
        x, y [m], shape [n, 2].
    """
    places = np.asarray(vertices, dtype=np.float64)
    parts = [places[:1]]
    for start, end in pairwise(places):
        pieces = max(1, int(np.ceil(np.hypot(*(end - start)) / (0.5 * heightfield.grid.dx))))
        share = np.arange(1, pieces + 1)[:, None] / pieces
        parts.append(start + share * (end - start))
    return np.concatenate(parts)


class LinePass:
    """Draped lines."""

    def __init__(self, ctx: moderngl.Context, heightfield: Heightfield) -> None:
        """Compile."""
        self._ctx = ctx
        self._heightfield = heightfield
        self._program = build_program(ctx, "line.vert", "line.frag")
        self._buffer = ctx.buffer(reserve=32)
        self._array = self._new_array()
        self._count = 0
        self._shown: tuple[DrapedLine, ...] = ()

    def draw(
        self,
        ground: GroundTextures,
        lines: tuple[DrapedLine, ...],
        slots: tuple[WaterSlot, WaterSlot] | None,
        alpha: float,
        render_scale: float,
    ) -> int:
        """Draw lines on the ground, or on the water over it, and return the number of draws."""
        if lines != self._shown:
            self._upload(lines)
            self._shown = lines
        if not self._count:
            return 0
        ground.height.use(0)
        if slots is not None:
            bind_slots(self._program, slots, alpha, unit=1)
        set_uniforms(self._program, over_water=int(slots is not None), width_px=_WIDTH_PX * render_scale)
        ctx = self._ctx
        ctx.enable_only(moderngl.DEPTH_TEST | moderngl.BLEND)
        ctx.blend_func = moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA
        self._array.render(moderngl.TRIANGLE_STRIP, vertices=4, instances=self._count)
        return 1

    def release(self) -> None:
        """Give the memory back."""
        for thing in (self._array, self._buffer, self._program):
            thing.release()

    def _upload(self, lines: tuple[DrapedLine, ...]) -> None:
        pieces = [self._pieces(line) for line in lines]
        records = np.concatenate(pieces) if pieces else np.zeros((0, 8), dtype="<f4")
        self._count = len(records)
        if records.nbytes > self._buffer.size:
            self._array.release()
            self._buffer.release()
            self._buffer = self._ctx.buffer(reserve=2 * records.nbytes)
            self._array = self._new_array()
        if self._count:
            self._buffer.write(records)

    def _pieces(self, line: DrapedLine) -> npt.NDArray[np.float32]:
        paths = [line.vertices] if len(line.vertices) > 1 else []
        if line.style in (LineStyle.DRAFT, LineStyle.SELECTED):
            # Rings show where the vertices are and how wide the edit will be.
            radius = max(0.5 * line.width, self._heightfield.grid.dx)
            paths += [_ring(vertex, radius) for vertex in line.vertices]
        records = []
        frame = self._heightfield.frame
        for path in paths:
            points = drape(self._heightfield, path) - (frame.x_centre, frame.y_centre)
            colour = np.broadcast_to(_COLOURS[line.style], (len(points) - 1, 4))
            records.append(np.hstack([points[:-1], points[1:], colour]))
        return np.concatenate(records).astype("<f4") if records else np.zeros((0, 8), dtype="<f4")

    def _new_array(self) -> moderngl.VertexArray:
        return self._ctx.vertex_array(
            self._program, [(self._buffer, "2f 2f 4f /i", "in_start", "in_end", "in_colour")]
        )


def _ring(centre: tuple[float, float], radius: float) -> tuple[tuple[float, float], ...]:
    angles = np.linspace(0.0, 2.0 * np.pi, _RING_POINTS)
    return tuple(
        (centre[0] + radius * float(np.cos(a)), centre[1] + radius * float(np.sin(a))) for a in angles
    )
