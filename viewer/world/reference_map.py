"""The small map that tells where the camera is: relief, flood extent, eye, target and the ground in view.

Rasters of a map are [row, col] with row 0 in the north, as pictures have it; places are grid coordinates [m].
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from viewer.world.camera import Camera
from viewer.world.coordinates import WorldFrame
from viewer.world.heightfield import Heightfield

__all__ = ["MapView", "flood_extent", "ground_in_view", "relief_map"]

MAP_PIXELS = 256
"""Longest side of a map [pixels]."""

VIEW_REACH = 5.0
"""The ground in view is drawn to this many times the eye's distance from its target."""

LOW, HIGH = np.array([112.0, 128.0, 92.0]), np.array([198.0, 188.0, 168.0])
"""sRGB of the lowest and the highest ground."""

LIGHT = (-0.5, 0.5, 0.707)
"""Unit vector to the light: east, north, up."""


@dataclass(frozen=True)
class MapView:
    """What a reference map shows."""

    relief: npt.NDArray[np.uint8]
    """Shaded ground, shape [rows, cols, 3]; the same array while the ground is the same."""
    flood: npt.NDArray[np.bool_]
    """Where there is water, shape [rows, cols]; the same array while the water is the same."""
    extent: tuple[float, float, float, float]
    """Western, southern, eastern and northern end [m]."""
    eye: tuple[float, float]
    """Place of the camera."""
    target: tuple[float, float]
    """Place it looks at."""
    in_view: tuple[tuple[float, float], ...]
    """Corners of the ground in view."""


def map_step(shape: tuple[int, ...]) -> int:
    """Cells along the side of a map pixel."""
    return max(1, -(-max(shape[:2]) // MAP_PIXELS))


def relief_map(heightfield: Heightfield) -> npt.NDArray[np.uint8]:
    """Shaded ground, shape [rows, cols, 3]."""
    step = map_step(heightfield.z_b.shape)
    z = heightfield.drawn[step // 2 :: step, step // 2 :: step].astype(np.float64)
    slope_y, slope_x = np.gradient(z, step * heightfield.grid.dx) if min(z.shape) > 1 else (0.0 * z, 0.0 * z)
    steepest = max(float(np.quantile(np.hypot(slope_x, slope_y), 0.98)), 1e-6)
    scale = 0.8 / steepest  # flat and alpine ground alike use the whole range of shades
    normal = np.sqrt(1.0 + (scale * slope_x) ** 2 + (scale * slope_y) ** 2)
    lit = (-scale * slope_x * LIGHT[0] - scale * slope_y * LIGHT[1] + LIGHT[2]) / normal
    span = max(heightfield.z_max - heightfield.z_min, 1e-6)
    height = np.clip((z - heightfield.z_min) / span, 0.0, 1.0)[..., None]
    colour = (LOW + (HIGH - LOW) * np.sqrt(height)) * (0.35 + 0.85 * np.clip(lit, 0.0, 1.0))[..., None]
    return np.ascontiguousarray(np.clip(colour, 0.0, 255.0).astype(np.uint8)[::-1])


def flood_extent(h: npt.NDArray[np.float32], depth_shown: float) -> npt.NDArray[np.bool_]:
    """Map pixels in which any cell is deeper than `depth_shown` [m], shape [rows, cols].

    A pixel stands for the cells round the one that `relief_map` takes, so that narrow water is not lost.
    """
    step = map_step(h.shape)
    starts = [np.arange(0, n, step)[: len(range(step // 2, n, step))] for n in h.shape]
    deepest = np.maximum.reduceat(np.maximum.reduceat(h, starts[0], axis=0), starts[1], axis=1)
    return np.ascontiguousarray((deepest > depth_shown)[::-1])


def ground_in_view(camera: Camera, aspect: float, frame: WorldFrame) -> tuple[tuple[float, float], ...]:
    """Corners of the ground that a camera sees, as a level plane through its target.

    Args:
        camera: the pose.
        aspect: width over height of the picture.
        frame: world frame of the picture.
    """
    eye = camera.eye
    reach = VIEW_REACH * camera.distance
    corners = []
    for x_ndc, y_ndc in ((-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)):
        ray = camera.ray(x_ndc, y_ndc, aspect)
        fall = -float(ray[1])
        along = (float(eye[1]) - camera.target[1]) / fall if fall > 1e-6 else math.inf
        flat = math.hypot(float(ray[0]), float(ray[2]))
        along = min(along, reach / max(flat, 1e-6))
        east, up, south = eye + along * ray
        x, y, _ = frame.from_world((east, up, south))
        corners.append((x, y))
    return tuple(corners)
