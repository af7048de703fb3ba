"""The orbit camera: a pose around a target point, its matrices and rays.

A camera is a value: moving it makes another one. World axes as in `coordinates`; matrices act on
column vectors; clip space is OpenGL's (z from -1 to 1).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from viewer.world.coordinates import Point

__all__ = ["Camera", "GroundHeight", "overview"]

GroundHeight = Callable[[Any, Any], Any]
"""Height of the ground in the world [m] over world x and z; takes scalars and arrays."""

Matrix = npt.NDArray[np.float64]

ELEVATION_MIN = math.radians(1.5)
ELEVATION_MAX = math.radians(90.0)


@dataclass(frozen=True)
class Camera:
    """A third-person pose: the eye looks at a target from a distance."""

    target: Point
    """The point looked at, in the world [m]."""
    distance: float
    """From the eye to the target [m], > 0."""
    azimuth: float
    """Compass bearing of the view direction, clockwise from north [rad]."""
    elevation: float
    """Angle of the eye above the horizon of the target [rad]; pi/2 looks straight down."""
    fov_y: float = math.radians(45.0)
    """Full vertical angle of view [rad]."""

    @cached_property
    def forward(self) -> Matrix:
        """Unit view direction, shape [3]."""
        c = math.cos(self.elevation)
        return np.array([c * math.sin(self.azimuth), -math.sin(self.elevation), -c * math.cos(self.azimuth)])

    @cached_property
    def right(self) -> Matrix:
        """Unit vector to the right of the picture, shape [3]."""
        return np.array([math.cos(self.azimuth), 0.0, math.sin(self.azimuth)])

    @cached_property
    def up(self) -> Matrix:
        """Unit vector to the top of the picture, shape [3]."""
        return np.cross(self.right, self.forward)

    @cached_property
    def eye(self) -> Matrix:
        """Position of the eye in the world [m], shape [3]."""
        return np.asarray(self.target, dtype=np.float64) - self.distance * self.forward

    def view_matrix(self) -> Matrix:
        """World to eye space, shape [4, 4]."""
        view = np.eye(4)
        view[0, :3], view[1, :3], view[2, :3] = self.right, self.up, -self.forward
        view[:3, 3] = -view[:3, :3] @ self.eye
        return view

    def projection(self, aspect: float, near: float, far: float) -> Matrix:
        """Perspective projection.

        Args:
            aspect: width over height of the picture.
            near: distance of the near plane [m], > 0.
            far: distance of the far plane [m], > near.
        """
        f = 1.0 / math.tan(0.5 * self.fov_y)
        matrix = np.zeros((4, 4))
        matrix[0, 0], matrix[1, 1] = f / aspect, f
        matrix[2, 2] = (far + near) / (near - far)
        matrix[2, 3] = 2.0 * far * near / (near - far)
        matrix[3, 2] = -1.0
        return matrix

    def ray(self, x_ndc: float, y_ndc: float, aspect: float) -> Matrix:
        """Unit direction through a place of the picture (both coordinates from -1 to 1, y up), shape [3]."""
        t = math.tan(0.5 * self.fov_y)
        direction = self.forward + x_ndc * t * aspect * self.right + y_ndc * t * self.up
        return direction / np.linalg.norm(direction)

    def seen_at(self, point: Point, aspect: float) -> tuple[float, float] | None:
        """Where a world point is on the picture (both from -1 to 1 within it, y up); None behind the eye."""
        towards = np.asarray(point, dtype=np.float64) - self.eye
        depth = float(towards @ self.forward)
        if depth <= 0.0:
            return None
        reach = depth * math.tan(0.5 * self.fov_y)
        return float(towards @ self.right) / (reach * aspect), float(towards @ self.up) / reach

    def with_target(self, target: Point) -> Camera:
        """The same view of another point."""
        return replace(self, target=(float(target[0]), float(target[1]), float(target[2])))

    def orbited(self, azimuth: float, elevation: float) -> Camera:
        """Turned around the target by two angles [rad]; the elevation stays between horizon and zenith."""
        turned = math.remainder(self.azimuth + azimuth, 2.0 * math.pi)
        raised = min(max(self.elevation + elevation, ELEVATION_MIN), ELEVATION_MAX)
        return replace(self, azimuth=turned, elevation=raised)

    def panned(self, right: float, forward: float) -> Camera:
        """Moved with its target over the ground, to the right and forward on the map [m]."""
        s, c = math.sin(self.azimuth), math.cos(self.azimuth)
        x, y, z = self.target
        return replace(self, target=(x + right * c + forward * s, y, z + right * s - forward * c))

    def zoomed(self, factor: float, distance_min: float = 2.0, distance_max: float = 1e6) -> Camera:
        """With the distance to the target multiplied by a factor, within limits [m]."""
        return replace(self, distance=min(max(self.distance * factor, distance_min), distance_max))

    def kept_above(self, ground: GroundHeight, clearance: float) -> Camera:
        """Raised, if need be, until the eye clears the ground; the target stays where it is.

        Args:
            ground: height of the ground in the world [m].
            clearance: how far the eye must be above it [m].
        """
        if float(self.eye[1]) >= float(ground(self.eye[0], self.eye[2])) + clearance:
            return self
        elevations = np.linspace(self.elevation, ELEVATION_MAX, 90)
        horizontal = self.distance * np.cos(elevations)
        x = self.target[0] - horizontal * math.sin(self.azimuth)
        z = self.target[2] + horizontal * math.cos(self.azimuth)
        y = self.target[1] + self.distance * np.sin(elevations)
        clear = np.flatnonzero(y >= ground(x, z) + clearance)
        if clear.size:
            return replace(self, elevation=float(elevations[clear[0]]))
        # Even straight above, the eye is under ground: the target itself lies too deep.
        lift = float(ground(self.target[0], self.target[2])) + clearance - self.target[1]
        lifted = (self.target[0], self.target[1] + max(lift, 0.0), self.target[2])
        return replace(self, target=lifted, elevation=ELEVATION_MAX)


def overview(
    extent_x: float,
    extent_z: float,
    height: float,
    azimuth: float = 0.0,
    elevation: float = math.radians(38.0),
    fov_y: float = math.radians(45.0),
    aspect: float = 16.0 / 9.0,
) -> Camera:
    """The camera that shows a whole map centred on the world's origin.

    Args:
        extent_x: size of the map from west to east [m].
        extent_z: size of the map from south to north [m].
        height: world height of its middle [m].
        azimuth: bearing of the view [rad].
        elevation: angle above the horizon [rad].
        fov_y: vertical angle of view [rad].
        aspect: width over height of the picture.
    """
    camera = Camera((0.0, height, 0.0), 1.0, azimuth, elevation, fov_y)
    corners = np.array([[sx * extent_x, 0.0, sz * extent_z] for sx in (-0.5, 0.5) for sz in (-0.5, 0.5)])
    t = math.tan(0.5 * fov_y)
    # The eye must stand off until each corner lies within both half angles.
    depth = corners @ camera.forward
    needed = np.maximum(
        np.abs(corners @ camera.right) / (t * aspect) - depth, np.abs(corners @ camera.up) / t - depth
    )
    return replace(camera, distance=float(needed.max()) * 1.04)
