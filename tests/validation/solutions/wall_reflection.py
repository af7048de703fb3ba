"""Water that runs into a wall: a bore goes back from it.

Source: Stoker (1957), "Water Waves", section 10.7; Toro (2001), "Shock-Capturing Methods for Free-Surface
Shallow Flows", section 5.3 (the wall is the middle of two mirrored states).

Water of depth h1 runs with u1 > 0 against a wall at x = 0. Behind the bore it is at rest with depth h2
(mass and momentum are kept across the bore of speed -s)::

    u1 = (h2 - h1) sqrt(g (h1 + h2) / (2 h1 h2)),    s = u1 h1 / (h2 - h1)
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

Array = NDArray[np.float64]


@dataclass(frozen=True)
class WallReflection:
    """Water of ``depth`` [m] that arrives with ``speed`` [m/s] at a wall at x = 0 at time 0."""

    depth: float
    speed: float
    gravity: float = 9.81

    @cached_property
    def reflected(self) -> tuple[float, float]:
        """Depth behind the bore [m] and the speed of the bore away from the wall [m/s]."""
        g, h1, u1 = self.gravity, self.depth, self.speed

        def mismatch(h: float) -> float:
            return float((h - h1) * np.sqrt(g * (h1 + h) / (2.0 * h1 * h)) - u1)

        h2 = float(brentq(mismatch, h1, 100.0 * h1, xtol=1e-14))
        return h2, u1 * h1 / (h2 - h1)

    def bed(self, x: Array, y: Array) -> Array:
        """Bed elevation [m]: flat."""
        return np.zeros(np.broadcast(x, y).shape)

    def state(self, x: Array, y: Array, time: float) -> tuple[Array, Array, Array]:
        """Depth [m] and velocity [m/s] before the wall; beyond it there is no water."""
        x = np.broadcast_to(x, np.broadcast(x, y).shape)
        h2, back = self.reflected
        behind = x > -back * time
        h = np.where(behind, h2, self.depth)
        u = np.where(behind, 0.0, self.speed)
        return np.where(x < 0.0, h, 0.0), np.where(x < 0.0, u, 0.0), np.zeros(x.shape)
