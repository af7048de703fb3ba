"""Dam break on a dry, flat, frictionless bed.

Source: Ritter (1892), "Die Fortpflanzung der Wasserwellen", Zeitschrift des Vereins Deutscher Ingenieure
36(33), 947-954; Delestre et al. (2013), SWASHES, section 4.1.2, Int. J. Numer. Meth. Fluids 72, 269-300.

With c = sqrt(g h_left) and xi = (x - x_dam) / t the solution is a single rarefaction::

    xi <= -c           h = h_left                     u = 0
    -c < xi < 2 c      h = (2 c - xi)^2 / (9 g)       u = 2 (xi + c) / 3
    xi >= 2 c          h = 0                          u = 0

``angle`` turns the direction of the flow from the x axis towards the y axis; the dam passes through (x_dam,
0).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Ritter:
    """Water of depth ``h_left`` [m] stands behind ``x_dam`` [m]; ``angle`` [rad]: flow direction."""

    h_left: float
    x_dam: float = 0.0
    angle: float = 0.0
    gravity: float = 9.81

    @property
    def celerity(self) -> float:
        """Celerity of the undisturbed water [m/s]."""
        return float(np.sqrt(self.gravity * self.h_left))

    def bed(self, x: Array, y: Array) -> Array:
        """Bed elevation [m]: flat."""
        return np.zeros(np.broadcast(x, y).shape)

    def state(self, x: Array, y: Array, time: float) -> tuple[Array, Array, Array]:
        """Depth [m] and velocity [m/s] at the points and the time [s]."""
        s = (x - self.x_dam) * np.cos(self.angle) + y * np.sin(self.angle)
        if time <= 0.0:
            return np.where(s < 0.0, self.h_left, 0.0), np.zeros(s.shape), np.zeros(s.shape)
        c, xi = self.celerity, s / time
        fan = np.clip(xi, -c, 2.0 * c)
        h = (2.0 * c - fan) ** 2 / (9.0 * self.gravity)
        speed = np.where(xi < 2.0 * c, 2.0 * (fan + c) / 3.0, 0.0)
        return h, speed * np.cos(self.angle), speed * np.sin(self.angle)
