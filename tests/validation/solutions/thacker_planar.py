"""Plane surface that circles in a paraboloid without friction: a shoreline that moves all the time.

Source: Thacker (1981), "Some exact solutions to the nonlinear shallow-water wave equations", J. Fluid Mech.
107, 499-508; Delestre et al. (2013), SWASHES, section 4.2.2 (planar surface in a paraboloid).

With r^2 = x^2 + y^2 around the centre, bed z_b = h0 (r^2 / a^2 - 1) and omega = sqrt(2 g h0) / a::

    eta = sigma h0 / a^2 (2 x cos(omega t) + 2 y sin(omega t) - sigma)
    u = -sigma omega sin(omega t),  v = sigma omega cos(omega t)            h = max(eta - z_b, 0)
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class ThackerPlanar:
    """Basin of radius ``a`` [m] and depth ``h0`` [m]; the centre circles at ``sigma`` [m].

    ``phase`` [rad] is the direction in which the centre of the water lies at time 0, from east to north.
    """

    a: float
    h0: float
    sigma: float
    phase: float = 0.0
    gravity: float = 9.81

    @property
    def omega(self) -> float:
        """Angular frequency [rad/s]."""
        return float(np.sqrt(2.0 * self.gravity * self.h0) / self.a)

    @property
    def period(self) -> float:
        """Time of one revolution [s]."""
        return 2.0 * np.pi / self.omega

    def volume(self) -> float:
        """Volume of the water [m3]: the wet disc keeps the radius a."""
        return float(0.5 * np.pi * self.h0 * self.a**2)

    def bed(self, x: Array, y: Array) -> Array:
        """Bed elevation [m]."""
        return self.h0 * ((x * x + y * y) / self.a**2 - 1.0)

    def state(self, x: Array, y: Array, time: float) -> tuple[Array, Array, Array]:
        """Depth [m] and velocity [m/s]; both are zero where the bed is dry."""
        turn = self.omega * time + self.phase
        cos, sin = np.cos(turn), np.sin(turn)
        eta = self.sigma * self.h0 / self.a**2 * (2.0 * (x * cos + y * sin) - self.sigma)
        h = np.maximum(eta - self.bed(x, y), 0.0)
        u = np.where(h > 0.0, -self.sigma * self.omega * sin, 0.0)
        v = np.where(h > 0.0, self.sigma * self.omega * cos, 0.0)
        return h, u, v
