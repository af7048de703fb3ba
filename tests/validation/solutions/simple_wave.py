"""A smooth nonlinear wave that runs one way over a flat bed, before it breaks.

Source: Stoker (1957), "Water Waves", section 10.5 (simple waves); Whitham (1974), "Linear and Nonlinear
Waves", section 13.10.

Where u - 2 c = -2 c0 everywhere, u and c = sqrt(g h) stay constant on straight lines dx/dt = u + c = 3 c -
2 c0::

    c(x, t) = c_start(x - (3 c - 2 c0) t),    u = 2 (c - c0)
    c_start(x) = sqrt(g h0) (1 + rise exp(-(x / width)^2))
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class SimpleWave:
    """Hump on water of depth ``h0`` [m], centred at 0; ``width`` [m]; ``rise`` is the relative rise of c."""

    h0: float
    rise: float
    width: float
    gravity: float = 9.81

    @property
    def celerity(self) -> float:
        """Celerity of the water at rest [m/s]."""
        return float(np.sqrt(self.gravity * self.h0))

    def breaking_time(self) -> float:
        """Time at which the steepest characteristics cross [s]."""
        steepest = self.celerity * self.rise / self.width * np.sqrt(2.0) * np.exp(-0.5)
        return float(1.0 / (3.0 * steepest))

    def bed(self, x: Array, y: Array) -> Array:
        """Bed elevation [m]: flat."""
        return np.zeros(np.broadcast(x, y).shape)

    def state(self, x: Array, y: Array, time: float) -> tuple[Array, Array, Array]:
        """Depth [m] and velocity [m/s]; the foot of each characteristic is found by bisection."""
        x = np.broadcast_to(x, np.broadcast(x, y).shape)
        c0 = self.celerity
        low, high = x - c0 * (1.0 + 3.0 * self.rise) * time, x - c0 * time
        for _ in range(60):
            foot = 0.5 * (low + high)
            speed = c0 * (1.0 + 3.0 * self.rise * np.exp(-((foot / self.width) ** 2)))
            short = foot + speed * time < x
            low, high = np.where(short, foot, low), np.where(short, high, foot)
        c = c0 * (1.0 + self.rise * np.exp(-((foot / self.width) ** 2)))
        return c * c / self.gravity, 2.0 * (c - c0), np.zeros(x.shape)
