"""Dam break on a dry, flat bed with Manning friction, to the first order of the friction.

Source: Dressler (1952), "Hydraulic resistance effect upon the dam-break functions", J. Res. Natl. Bur.
Stand. 49(3), 217-225; Delestre et al. (2013), SWASHES, section 4.1.3, both with Chezy's friction. Here the
same expansion is made for friction R u^2 / c^p, of which Chezy is p = 2, R = g^2 / C^2 and Manning p = 8/3, R
= g^(7/3) n^2.

With c = sqrt(g h), c_l = sqrt(g h_left), z = (2 - x / (c_l t)) / 3, Ritter's solution is c = c_l z, u = 2 c_l
(1 - z), and its correction is of the order delta = R t c_l^(1 - p)::

    c = c_l (z + delta C(z)),    u = c_l (2 (1 - z) + delta U(z))
    z C' - 3/2 C = z S' / 8 + S / 4,    U = (10 C - 3 S) / 7,    S = 4 (1 - z)^2 z^(-p),    C(1) = 0

whose solution is a sum of powers. It holds from the calm water to where u is largest; before the dry front
friction is not small and another law rules.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def corrections(z: Array, power: float) -> tuple[Array, Array]:
    """C(z) and U(z) for 0 < z <= 1 with the ``power`` p of the celerity in the friction."""
    exponents = np.array([0.0, 1.0, 2.0]) - power
    weights = np.array([1.0, -2.0, 1.0]) * (0.5 * exponents + 1.0) / (exponents - 1.5)
    celerity = sum(w * z**e for w, e in zip(weights, exponents, strict=True)) - weights.sum() * z**1.5
    return celerity, (10.0 * celerity - 12.0 * (1.0 - z) ** 2 * z**-power) / 7.0


@dataclass(frozen=True)
class Dressler:
    """Water of depth ``h_left`` [m] stands behind the dam at the origin; ``angle`` [rad]: flow direction."""

    h_left: float
    manning_n: float
    angle: float = 0.0
    gravity: float = 9.81

    @property
    def celerity(self) -> float:
        """Celerity of the undisturbed water [m/s]."""
        return float(np.sqrt(self.gravity * self.h_left))

    def strength(self, time: float) -> float:
        """delta, the size of the correction [1]."""
        drag = self.gravity ** (7.0 / 3.0) * self.manning_n**2
        return float(drag * time * self.celerity ** (-5.0 / 3.0))

    def _fields(self, z: Array, time: float) -> tuple[Array, Array]:
        c, u = corrections(z, 8.0 / 3.0)
        delta = self.strength(time)
        return z + delta * c, 2.0 * (1.0 - z) + delta * u

    def reach(self, time: float) -> float:
        """Where the velocity is largest [m]: the expansion holds behind it."""
        z = np.linspace(1.0, 0.02, 9801)
        fastest = int(np.argmax(self._fields(z, time)[1]))
        return float(self.celerity * time * (2.0 - 3.0 * z[fastest]))

    def bed(self, x: Array, y: Array) -> Array:
        """Bed elevation [m]: flat."""
        return np.zeros(np.broadcast(x, y).shape)

    def state(self, x: Array, y: Array, time: float) -> tuple[Array, Array, Array]:
        """Depth [m] and velocity [m/s]; beyond ``reach`` they are held and mean nothing."""
        s = x * np.cos(self.angle) + y * np.sin(self.angle)
        if time <= 0.0:
            return np.where(s < 0.0, self.h_left, 0.0), np.zeros(s.shape), np.zeros(s.shape)
        s = np.minimum(s, self.reach(time))
        z = np.clip((2.0 - s / (self.celerity * time)) / 3.0, 0.01, 1.0)
        c, u = self._fields(z, time)
        speed = self.celerity * u
        return self.h_left * c * c, speed * np.cos(self.angle), speed * np.sin(self.angle)
