"""Depth as 16-bit fixed point.

    q = 0                                        if h < depth_wet
    q = min(max(1, round(h / scale)), 65535)     otherwise
    h' = q scale

The division is float32 and the rounding half to even, so that a device gives the same bits. Up to 65535 scale
the error |h - h'| is at most max(scale / 2, depth_wet), but scale - depth_wet where a thin wet cell
(depth_wet <= h < scale / 2) is lifted to one unit so that it stays wet: see `depth_error_bound`.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from protocol.blocks import UInt16Array
from protocol.errors import FrameError

Q_MAX = 65535
"""Largest quantised depth."""

HEADROOM = 1.5
"""How far the water may rise above the deepest seen before a scale runs out."""

FloatArray = npt.NDArray[np.float32]


def quantise_depth(h: npt.ArrayLike, scale: float, depth_wet: float) -> UInt16Array:
    """Quantise depths.

    Args:
        h: depth [m], any shape.
        scale: depth of one unit [m].
        depth_wet: depth [m] below which a cell counts as dry.

    Returns:
        Fixed-point depth; depths that are not numbers count as dry.
    """
    h = np.asarray(h, dtype=np.float32)
    ratio = np.asarray(np.divide(h, np.float32(scale)))
    np.rint(ratio, out=ratio)
    # fmin and fmax take the number where the other is none, so a NaN never reaches the integer cast.
    np.fmax(ratio, np.float32(1.0), out=ratio)
    np.fmin(ratio, np.float32(Q_MAX), out=ratio)
    q = ratio.astype(np.uint16)
    q *= np.greater_equal(h, np.float32(depth_wet))
    return q


def dequantise_depth(q: npt.ArrayLike, scale: float) -> FloatArray:
    """Depth [m] as float32 of fixed-point depths."""
    return np.asarray(q).astype(np.float32) * np.float32(scale)


def depth_error_bound(scale: float, depth_wet: float) -> float:
    """Largest |h - h'| [m] for 0 <= h <= 65535 scale, float32 rounding of h' aside."""
    if depth_wet < 0.5 * scale:
        return scale - depth_wet
    return max(0.5 * scale, depth_wet)


def choose_depth_scale(h_max: float) -> float:
    """Finest scale [m] of the series 1, 2, 5, 10, ... mm that leaves 1.5 times h_max [m] in range.

    Raises:
        FrameError: when h_max is not finite.
    """
    if not math.isfinite(h_max):
        raise FrameError(f"The largest depth is {h_max!r}; a finite depth is allowed.")
    decade = 1
    while HEADROOM * h_max > Q_MAX * 5 * decade / 1000:
        decade *= 10
    return next(m * decade / 1000 for m in (1, 2, 5) if HEADROOM * h_max <= Q_MAX * m * decade / 1000)
