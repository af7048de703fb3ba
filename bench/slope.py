"""Does something grow? A straight line through samples, with the bounds of its slope.

Samples that follow each other closely are not independent, so the line goes through the means of blocks; its
slope lies between the bounds with 95 % confidence (Student's t for the residuals of the blocks). Something
grows if even the lower bound, over the whole time, makes more than what is allowed: a large slope that is
only noise does not count, nor a certain one that is tiny.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import stats

BLOCKS = 20
CONFIDENCE = 0.95


@dataclass(frozen=True)
class Slope:
    """A line through samples.

    Attributes:
        growth: change over the whole time along the line.
        least: lower bound of the growth.
        most: upper bound of the growth.
    """

    growth: float
    least: float
    most: float

    def exceeds(self, allowed: float) -> bool:
        """Whether it grows by more than what is allowed, beyond doubt."""
        return self.least > allowed


def slope_of(times: Sequence[float], values: Sequence[float], blocks: int = BLOCKS) -> Slope:
    """The growth of values over their time.

    Args:
        times: when each was sampled, rising.
        values: the samples.
        blocks: means of so many blocks are used.

    Raises:
        ValueError: there are fewer samples than blocks, or fewer than three blocks.
    """
    if blocks < 3 or len(times) < blocks:
        raise ValueError(f"{len(times)} samples in {blocks} blocks; 3 blocks with a sample each are needed")
    t = np.array([part.mean() for part in np.array_split(np.asarray(times, float), blocks)])
    y = np.array([part.mean() for part in np.array_split(np.asarray(values, float), blocks)])
    line = stats.linregress(t, y)
    span = float(times[-1] - times[0])
    half = float(stats.t.ppf(0.5 + 0.5 * CONFIDENCE, blocks - 2) * line.stderr)
    slope = float(line.slope)
    return Slope(slope * span, (slope - half) * span, (slope + half) * span)
