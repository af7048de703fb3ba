"""Curved surface that swells and sinks in a paraboloid without friction, radially symmetric.

Source: Thacker (1981), J. Fluid Mech. 107, 499-508; Delestre et al. (2013), SWASHES, section 4.2.2
(radially symmetrical paraboloid).

With r^2 = x^2 + y^2, bed z_b = h0 (r^2 / a^2 - 1), omega = sqrt(8 g h0) / a, A = (a^2 - r0^2) / (a^2 +
r0^2) and q = 1 - A cos(omega t)::

    eta = h0 (sqrt(1 - A^2) / q - 1 - r^2 / a^2 ((1 - A^2) / q^2 - 1))
    (u, v) = omega A sin(omega t) / (2 q) (x, y)                            h = max(eta - z_b, 0)
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class ThackerRadial:
    """Basin of radius ``a`` [m] and depth ``h0`` [m]; ``r0`` [m] sets the amplitude as in SWASHES.

    The formulas put the shore at time 0 at sqrt(a r0), not at r0.
    """

    a: float
    h0: float
    r0: float
    gravity: float = 9.81

    @property
    def omega(self) -> float:
        """Angular frequency [rad/s]."""
        return float(np.sqrt(8.0 * self.gravity * self.h0) / self.a)

    @property
    def period(self) -> float:
        """Time of one oscillation [s]."""
        return 2.0 * np.pi / self.omega

    @property
    def amplitude(self) -> float:
        """The dimensionless amplitude A."""
        return (self.a**2 - self.r0**2) / (self.a**2 + self.r0**2)

    def shore(self, time: float) -> float:
        """Radius of the shoreline [m]."""
        q = 1.0 - self.amplitude * np.cos(self.omega * time)
        return float(self.a * np.sqrt(q / np.sqrt(1.0 - self.amplitude**2)))

    def volume(self) -> float:
        """Volume of the water [m3]."""
        return float(0.5 * np.pi * self.h0 * self.a**2)

    def bed(self, x: Array, y: Array) -> Array:
        """Bed elevation [m]."""
        return self.h0 * ((x * x + y * y) / self.a**2 - 1.0)

    def state(self, x: Array, y: Array, time: float) -> tuple[Array, Array, Array]:
        """Depth [m] and velocity [m/s]; both are zero where the bed is dry."""
        big, cos = self.amplitude, np.cos(self.omega * time)
        q = 1.0 - big * cos
        r2 = (x * x + y * y) / self.a**2
        eta = self.h0 * (np.sqrt(1.0 - big**2) / q - 1.0 - r2 * ((1.0 - big**2) / q**2 - 1.0))
        h = np.maximum(eta - self.bed(x, y), 0.0)
        rate = 0.5 * self.omega * big * np.sin(self.omega * time) / q
        return h, np.where(h > 0.0, rate * x, 0.0), np.where(h > 0.0, rate * y, 0.0)
