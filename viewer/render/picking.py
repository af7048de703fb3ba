"""From a pixel of a picture back to the world."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from viewer.world.camera import Camera
from viewer.world.coordinates import Point, WorldFrame
from viewer.world.heightfield import Heightfield

__all__ = ["Unprojection", "march_ray"]


@dataclass(frozen=True)
class Unprojection:
    """The way back from the pixels of one picture."""

    inverse: npt.NDArray[np.float64]
    """Inverse of the view-projection matrix, shape [4, 4]."""
    size: tuple[int, int]
    """Width and height [pixels]."""
    frame: WorldFrame

    def world(
        self, column: npt.ArrayLike, row: npt.ArrayLike, depth: npt.ArrayLike
    ) -> npt.NDArray[np.float64]:
        """World points [m], shape [..., 3], of pixel centres and their depths.

        Args:
            column: counted from the left.
            row: counted from the bottom.
            depth: 0 at the near plane, 1 at the far plane.
        """
        x = 2.0 * (np.asarray(column, dtype=np.float64) + 0.5) / self.size[0] - 1.0
        y = 2.0 * (np.asarray(row, dtype=np.float64) + 0.5) / self.size[1] - 1.0
        z = 2.0 * np.asarray(depth, dtype=np.float64) - 1.0
        clip = np.stack(np.broadcast_arrays(x, y, z, np.float64(1.0)), axis=-1) @ self.inverse.T
        return clip[..., :3] / clip[..., 3:]

    def place(self, column: int, row: int, depth: float) -> Point:
        """Grid coordinates (x, y, elevation) of a pixel centre counted from the lower left."""
        world = self.world(column, row, depth)
        return self.frame.from_world((float(world[0]), float(world[1]), float(world[2])))


def march_ray(
    camera: Camera, x_ndc: float, y_ndc: float, aspect: float, heightfield: Heightfield, frame: WorldFrame
) -> Point | None:
    """Where a line of sight meets the ground, without any picture.

    Args:
        camera: the view.
        x_ndc: from -1 at the left to 1 at the right.
        y_ndc: from -1 at the bottom to 1 at the top.
        aspect: width over height of the picture.
        heightfield: the ground.
        frame: world frame with the vertical exaggeration drawn.

    Returns:
        grid coordinates and elevation (x, y, z), or None if the line misses the map.
    """
    grid = heightfield.grid
    direction, eye = camera.ray(x_ndc, y_ndc, aspect), camera.eye
    half = np.array([0.5 * grid.ncols * grid.dx, 0.5 * grid.nrows * grid.dx])
    low, high = frame.height(heightfield.z_min) - 1e-3, frame.height(heightfield.z_max) + 1e-3
    with np.errstate(divide="ignore", invalid="ignore"):
        bounds = np.array([[-half[0], half[0]], [low, high], [-half[1], half[1]]])
        at = np.sort((bounds - eye[:, None]) / direction[:, None], axis=1)
    at = np.where(np.isnan(at), [-np.inf, np.inf], at)
    enter, leave = max(float(at[:, 0].max()), 0.0), float(at[:, 1].min())
    if not enter < leave < np.inf:
        return None
    # Half a cell at a time to the first point under ground, then ever finer between it and the one before.
    count = 2 + int(min((leave - enter) / (0.5 * grid.dx), 20_000))
    for _ in range(4):
        steps = np.linspace(enter, leave, count)
        points = eye + steps[:, None] * direction
        under = points[:, 1] <= heightfield.world_height(points[:, 0], points[:, 2], frame)
        if not under.any():
            return None
        first = int(np.argmax(under))
        enter, leave, count = float(steps[max(first - 1, 0)]), float(steps[first]), 32
    point = eye + leave * direction
    return frame.from_world((float(point[0]), float(point[1]), float(point[2])))
