"""The uniform block that all passes of a picture share (`shaders/common/frame.glsl`)."""

from __future__ import annotations

import math

import moderngl
import numpy as np

from viewer.lod import BlockTiling
from viewer.render.frame_inputs import FrameInputs
from viewer.world.coordinates import WorldFrame

__all__ = ["FrameUniforms", "sun_direction"]

HORIZON = (0.80, 0.86, 0.92)
_FOG_REACH = 4.0
"""Map sizes after which the air lets about a third of a colour through."""


def sun_direction(azimuth_deg: float, elevation_deg: float) -> tuple[float, float, float]:
    """Unit vector to the sun in world axes from compass bearing and height [degrees]."""
    a, e = math.radians(azimuth_deg), math.radians(elevation_deg)
    return (math.cos(e) * math.sin(a), math.sin(e), -math.cos(e) * math.cos(a))


class FrameUniforms:
    """Writes the uniform block of a picture."""

    def __init__(self, ctx: moderngl.Context, tiling: BlockTiling, dx: float) -> None:
        """Allocate.

        Args:
            ctx: the OpenGL context.
            tiling: the blocks.
            dx: cell size [m].
        """
        self._grid = (tiling.ncols, tiling.nrows, tiling.stride, dx)
        self._last = (tiling.drawn_cols - 1, tiling.drawn_rows - 1)
        self._map_size = max(tiling.nrows, tiling.ncols) * dx
        self._values = np.zeros((11, 4), dtype="<f4")
        self._buffer = ctx.buffer(reserve=self._values.nbytes)

    def write(
        self,
        inputs: FrameInputs,
        frame: WorldFrame,
        view_projection: np.ndarray,
        size: tuple[int, int],
        skirt_foot: float,
    ) -> None:
        """Fill the block and bind it.

        Args:
            inputs: the picture.
            frame: world frame with the exaggeration drawn.
            view_projection: shape [4, 4], acting on column vectors.
            size: width and height [pixels].
            skirt_foot: elevation down to which the walls of the map reach [m].
        """
        options = inputs.options
        values = self._values
        values[0:4] = view_projection.T
        values[4, :3] = inputs.camera.eye
        values[5, :3] = sun_direction(options.light_azimuth_deg, options.light_elevation_deg)
        reach = _FOG_REACH * self._map_size + inputs.camera.distance
        values[6] = (*HORIZON, 1.0 / reach if options.fog else 0.0)
        values[7] = self._grid
        values[8] = (frame.exaggeration, frame.z_ref, options.contour_interval, skirt_foot)
        values[9] = (*size, options.depth_shown, float(options.show_blocks))
        values[10, :2] = self._last
        self._buffer.write(values)
        self._buffer.bind_to_uniform_block(0)

    def release(self) -> None:
        """Give the memory back."""
        self._buffer.release()
