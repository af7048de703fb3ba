"""A smooth steady vortex on a flat bed: pressure and centrifugal force in balance in two dimensions.

Source: Ricchiuto and Bollermann (2009), J. Comput. Phys. 228, 1071-1115, section 5.2 (travelling vortex),
here at rest and with the Gaussian profile that is usual for the Euler equations (Yee et al. 1999, J.
Comput. Phys. 150, 199-238).

Any swirl V(r) is steady where g dh/dr = V^2 / r. With V = peak (r / radius) exp((1 - r^2 / radius^2) / 2)::

    h = h0 - peak^2 exp(1 - r^2 / radius^2) / (2 g),    (u, v) = V / r (-y, x)
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class StationaryVortex:
    """Water of depth ``h0`` [m] that turns around the origin, fastest (``peak`` [m/s]) at ``radius`` [m]."""

    h0: float
    peak: float
    radius: float
    gravity: float = 9.81

    def bed(self, x: Array, y: Array) -> Array:
        """Bed elevation [m]: flat."""
        return np.zeros(np.broadcast(x, y).shape)

    def state(self, x: Array, y: Array, time: float) -> tuple[Array, Array, Array]:
        """Depth [m] and velocity [m/s], the same at every time."""
        r2 = (x * x + y * y) / self.radius**2
        h = self.h0 - self.peak**2 * np.exp(1.0 - r2) / (2.0 * self.gravity)
        spin = self.peak / self.radius * np.exp(0.5 * (1.0 - r2))
        return h, -spin * y, spin * x
