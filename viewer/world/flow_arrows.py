"""Where arrows of the flow stand: on a grid of cells that is as fine as the picture can carry.

The grid is nested: the cells of a coarse one belong to every finer one, so arrows stay where they are while
the camera comes nearer and others appear between them. Each place takes the finest grid whose arrows stand at
least `SPACING_PX` apart on the picture (seen from above).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from viewer.world.camera import Camera
from viewer.world.coordinates import WorldFrame
from viewer.world.heightfield import Heightfield

__all__ = ["Arrows", "FlowField", "arrow_speed", "flow_arrows"]

SPACING_PX = 40.0
"""Least distance of arrows on a picture 720 pixels high."""
LONGEST_PX = 38.0
"""Length of the arrow of the fastest water on such a picture; slower water has shorter ones in proportion."""
SHORTEST_PX = 9.0
WIDTH_PX = 9.0
LEAST_DEPTH = 0.05
"""Water shallower than this has no arrow [m]."""
LEAST_SPEED = 0.02
"""Nor has water slower than this [m/s]."""
_HEIGHT_PX = 720.0

Field = npt.NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class FlowField:
    """Velocity of the water at two frames, and between them, as the depth is."""

    u_first: Field
    """To the east [m/s], shape [nrows, ncols]."""
    v_first: Field
    """To the north [m/s]."""
    u_second: Field
    v_second: Field
    fast: float
    """A speed that little water exceeds [m/s]."""


@dataclass(frozen=True, eq=False)
class Arrows:
    """Arrows to draw."""

    records: npt.NDArray[np.float32]
    """East and north of the grid's centre, length along east and north, width [m], shape [n, 5]."""
    speed: float
    """Speed of water whose arrow is `LONGEST_PX` long [m/s]."""


def arrow_speed(fast: float) -> float:
    """The speed of the longest arrow [m/s]: the least of 1, 2, 5 times a power of ten not below `fast`."""
    wanted = max(fast, 0.1)
    power = 10.0 ** math.floor(math.log10(wanted))
    return next(power * k for k in (1.0, 2.0, 5.0, 10.0) if power * k >= wanted * (1.0 - 1e-9))


def flow_arrows(
    camera: Camera,
    aspect: float,
    heightfield: Heightfield,
    frame: WorldFrame,
    depths: tuple[Field, Field],
    flow: FlowField,
    alpha: float,
) -> Arrows:
    """The arrows of a picture.

    Args:
        camera: the view.
        aspect: width over height of the picture.
        heightfield: the ground.
        frame: world frame with the vertical exaggeration drawn.
        depths: depth of both frames [m], shape [nrows, ncols].
        flow: velocity of both frames.
        alpha: 0 for the first frame, 1 for the second.
    """
    grid = heightfield.grid
    reach = SPACING_PX * 2.0 * math.tan(0.5 * camera.fov_y) / _HEIGHT_PX
    """Spacing over distance."""
    levels = max(1, math.ceil(math.log2(max(grid.nrows, grid.ncols))))
    parts = []
    for level in range(levels):
        step = 1 << level
        rows, cols = _cells_near(camera, heightfield, step, step * grid.dx / reach)
        if rows.size:
            parts.append(np.stack([rows, cols, np.full(rows.size, level)]))
    rows, cols, level_of = np.concatenate(parts, axis=1) if parts else np.zeros((3, 0), np.int64)
    share = np.float32(alpha)

    def between(first: Field, second: Field) -> Field:
        blended: Field = first[rows, cols] * (np.float32(1.0) - share) + second[rows, cols] * share
        return blended

    h = between(*depths)
    u, v = between(flow.u_first, flow.u_second), between(flow.v_first, flow.v_second)
    speed = np.hypot(u, v)
    east = (cols - 0.5 * (grid.ncols - 1)) * grid.dx
    north = (rows - 0.5 * (grid.nrows - 1)) * grid.dx
    up = frame.height(heightfield.z_b[rows, cols] + h)
    away = np.stack([east, up, -north], axis=1) - camera.eye
    distance = np.linalg.norm(away, axis=1)
    right_level = np.ceil(np.log2(np.maximum(reach * distance / grid.dx, 1e-6))).clip(0, levels - 1)
    ahead = away @ camera.forward
    slope = math.tan(0.5 * camera.fov_y) * 1.05
    seen = (ahead > 0.0) & (np.abs(away @ camera.up) < slope * ahead)
    seen &= np.abs(away @ camera.right) < slope * aspect * ahead
    kept = seen & (right_level == level_of) & (h >= LEAST_DEPTH) & (speed >= LEAST_SPEED)

    fastest = arrow_speed(flow.fast)
    pixel = (reach / SPACING_PX) * distance[kept]
    length = np.clip(LONGEST_PX * speed[kept] / fastest, SHORTEST_PX, 1.4 * LONGEST_PX) * pixel
    records = np.stack(
        [
            east[kept],
            north[kept],
            u[kept] / speed[kept] * length,
            v[kept] / speed[kept] * length,
            WIDTH_PX * pixel,
        ],
        axis=1,
    )
    return Arrows(records.astype(np.float32), fastest)


def _cells_near(
    camera: Camera, heightfield: Heightfield, step: int, distance: float
) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]:
    """Cells of one grid that may be within a distance of the eye."""
    grid = heightfield.grid
    col = float(camera.eye[0]) / grid.dx + 0.5 * (grid.ncols - 1)
    row = -float(camera.eye[2]) / grid.dx + 0.5 * (grid.nrows - 1)
    reach = distance / grid.dx
    places = []
    for at, count in ((row, grid.nrows), (col, grid.ncols)):
        first, last = max(0, math.ceil((at - reach) / step)), min(count - 1, math.floor(at + reach)) // step
        places.append(np.arange(first, last + 1, dtype=np.int64) * step)
    near = np.meshgrid(*places, indexing="ij")
    return near[0].ravel(), near[1].ravel()
