"""Depth classes for emergency decisions, and their colours.

The limits follow what people and vehicles can stand: 0.15 m stops walking children, 0.3 m floats small cars,
0.5 m stops most cars, 0.76 m (30 inches) stops emergency trucks, 1 m and 2 m threaten adults and
ground floors.
The colours run light to dark in one direction of lightness, so they stay apart for every kind of
colour vision.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import numpy.typing as npt

__all__ = ["DEPTH_CLASS_COLOURS", "DEPTH_CLASS_LIMITS", "depth_class", "depth_class_labels"]

DEPTH_CLASS_LIMITS: tuple[float, ...] = (0.15, 0.3, 0.5, 0.76, 1.0, 2.0)
"""Upper limits of all classes but the last [m]."""

DEPTH_CLASS_COLOURS: tuple[tuple[int, int, int], ...] = (
    (255, 247, 188),
    (254, 217, 118),
    (253, 174, 97),
    (240, 110, 100),
    (200, 60, 125),
    (130, 35, 140),
    (60, 15, 95),
)
"""One sRGB colour a class, from shallow to deep."""


def depth_class(h: npt.ArrayLike) -> npt.NDArray[np.intp]:
    """Index of the class of each depth [m]: 0 below the first limit, and so on."""
    return np.searchsorted(np.asarray(DEPTH_CLASS_LIMITS), np.asarray(h), side="right")


def depth_class_labels() -> tuple[str, ...]:
    """Text of each class for a legend [m]."""
    limits = [f"{limit:g}" for limit in DEPTH_CLASS_LIMITS]
    between = [f"{low} - {high}" for low, high in pairwise(limits)]
    return (f"< {limits[0]}", *between, f"> {limits[-1]}")
