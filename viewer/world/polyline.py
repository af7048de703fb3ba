"""Lines and rings of map points: fewer points of the same shape, and what lies near a place."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

__all__ = ["Place", "distance_to_line", "is_within", "nearest_vertex", "simplified"]

Place = tuple[float, float]
"""x and y [m]."""


def simplified(points: Sequence[Place], tolerance: float) -> list[Place]:
    """Leave out points that the line through the others passes near enough.

    Douglas and Peucker (1973), doi:10.3138/FM57-6770-U75U-7727.

    Args:
        points: the line; its ends stay.
        tolerance: farthest that a point left out may lie from the line that remains [m].
    """
    places = np.asarray(points, dtype=np.float64).reshape(-1, 2)
    kept = np.zeros(len(places), dtype=bool)
    kept[:1] = kept[-1:] = True
    open_parts = [(0, len(places) - 1)]
    while open_parts:
        first, last = open_parts.pop()
        if last - first < 2:
            continue
        away = _distances(places[first + 1 : last], places[first], places[last])
        farthest = int(np.argmax(away))
        if away[farthest] > tolerance:
            middle = first + 1 + farthest
            kept[middle] = True
            open_parts += [(first, middle), (middle, last)]
    return [point for point, is_kept in zip(points, kept, strict=True) if is_kept]


def distance_to_line(points: Sequence[Place], at: Place) -> float:
    """How far a place is from a line of at least one point [m]."""
    place = np.array([at], dtype=np.float64)
    places = np.asarray(points, dtype=np.float64)
    starts, ends = (places[:-1], places[1:]) if len(places) > 1 else (places, places)
    return min(float(_distances(place, start, end)[0]) for start, end in zip(starts, ends, strict=True))


def nearest_vertex(points: Sequence[Place], at: Place) -> tuple[int, float]:
    """Number of the point nearest to a place, and how far it is [m]."""
    away = [math.dist(point, at) for point in points]
    number = min(range(len(away)), key=away.__getitem__)
    return number, away[number]


def is_within(ring: Sequence[Place], at: Place) -> bool:
    """Whether a place is inside a ring by the even-odd rule; the last point is joined to the first."""
    x, y = at
    inside = False
    ax, ay = ring[-1]
    for bx, by in ring:
        if (ay > y) != (by > y) and x < ax + (y - ay) / (by - ay) * (bx - ax):
            inside = not inside
        ax, ay = bx, by
    return inside


def _distances(
    places: npt.NDArray[np.float64], start: npt.NDArray[np.float64], end: npt.NDArray[np.float64]
) -> npt.NDArray[np.float64]:
    """Distances of places [n, 2] from the segment between two points."""
    along = end - start
    length2 = float(along @ along)
    share = np.clip((places - start) @ along / length2, 0.0, 1.0) if length2 > 0.0 else np.zeros(len(places))
    away = places - start - share[:, None] * along
    distances: npt.NDArray[np.float64] = np.sqrt((away * away).sum(axis=1))
    return distances
