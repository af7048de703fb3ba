"""How long a line is on the map and over the ground, and how large the area within it is.

The area is that of the closed ring on the map, by the shoelace formula: half of |sum(x_i y_j - x_j y_i)| with
j = i + 1.
A ring that crosses itself counts what it goes round the other way as negative.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from viewer.world.heightfield import Heightfield

__all__ = ["Measure", "measure"]

Place = tuple[float, float]
MOST_SAMPLES = 4096
"""Ground samples along one side of a line at most."""


@dataclass(frozen=True)
class Measure:
    """A line in numbers.

    Attributes:
        length: on the map [m].
        ground_length: over the ground, up and down [m].
        rise: how much higher the ground is at the end than at the beginning [m].
        area: of the closed ring on the map [m2]; 0 for less than three points.
        perimeter: of that ring [m].
    """

    length: float
    ground_length: float
    rise: float
    area: float
    perimeter: float


def measure(points: Sequence[Place], ground: Heightfield) -> Measure:
    """Measure a line of at least one point.

    Args:
        points: its points (x, y) [m].
        ground: what it lies on; sampled about once a cell.
    """
    length = math.fsum(math.dist(a, b) for a, b in pairwise(points))
    closing = math.dist(points[-1], points[0])
    heights = [float(ground.sample(*point)) for point in (points[0], points[-1])]
    ring = [*points, points[0]]
    twice = math.fsum(ax * by - bx * ay for (ax, ay), (bx, by) in pairwise(_about(points[0], ring)))
    return Measure(
        length,
        math.fsum(_over_ground(a, b, ground) for a, b in pairwise(points)),
        heights[1] - heights[0],
        0.5 * abs(twice) if len(points) >= 3 else 0.0,
        length + closing,
    )


def _about(origin: Place, points: Sequence[Place]) -> list[Place]:
    """The points with a near origin: coordinates of a map are large, their products lose digits."""
    return [(x - origin[0], y - origin[1]) for x, y in points]


def _over_ground(a: Place, b: Place, ground: Heightfield) -> float:
    parts = min(MOST_SAMPLES, max(1, math.ceil(math.dist(a, b) / ground.grid.dx)))
    share = np.linspace(0.0, 1.0, parts + 1)
    x, y = a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])
    z = np.asarray(ground.sample(x, y), dtype=np.float64)
    return float(np.sqrt(np.diff(x) ** 2 + np.diff(y) ** 2 + np.diff(z) ** 2).sum())
