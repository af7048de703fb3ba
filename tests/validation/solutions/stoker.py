"""Dam break on a wet, flat, frictionless bed: a rarefaction, a plateau and a bore.

Source: Stoker (1957), "Water Waves", section 10.8; Delestre et al. (2013), SWASHES, section 4.1.1.

The plateau depth h_m joins the rarefaction, u_m = 2 (sqrt(g h_left) - sqrt(g h_m)), to the bore, which
keeps mass and momentum (Rankine-Hugoniot)::

    u_m = (h_m - h_right) sqrt(g (h_m + h_right) / (2 h_m h_right))
    bore speed s = u_m h_m / (h_m - h_right)

``angle`` turns the direction of the flow from the x axis towards the y axis; the dam passes through the
origin.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Stoker:
    """Depths ``h_left`` > ``h_right`` [m] behind and before the dam; ``angle`` [rad]: flow direction."""

    h_left: float
    h_right: float
    angle: float = 0.0
    gravity: float = 9.81

    @cached_property
    def plateau(self) -> tuple[float, float, float]:
        """Depth [m], velocity [m/s] of the plateau and speed of the bore [m/s]."""
        g, left, right = self.gravity, self.h_left, self.h_right

        def mismatch(h: float) -> float:
            rarefaction = 2.0 * (np.sqrt(g * left) - np.sqrt(g * h))
            return float(rarefaction - (h - right) * np.sqrt(g * (h + right) / (2.0 * h * right)))

        h_m = float(brentq(mismatch, right, left, xtol=1e-14))
        u_m = 2.0 * float(np.sqrt(g * left) - np.sqrt(g * h_m))
        return h_m, u_m, u_m * h_m / (h_m - right)

    def bed(self, x: Array, y: Array) -> Array:
        """Bed elevation [m]: flat."""
        return np.zeros(np.broadcast(x, y).shape)

    def state(self, x: Array, y: Array, time: float) -> tuple[Array, Array, Array]:
        """Depth [m] and velocity [m/s] at the points and the time [s]."""
        s = x * np.cos(self.angle) + y * np.sin(self.angle)
        if time <= 0.0:
            return np.where(s < 0.0, self.h_left, self.h_right), np.zeros(s.shape), np.zeros(s.shape)
        h_m, u_m, bore = self.plateau
        g, xi = self.gravity, s / time
        c_left, c_m = np.sqrt(g * self.h_left), np.sqrt(g * h_m)
        fan = np.clip(xi, -c_left, u_m - c_m)
        before = xi > bore
        h = np.where(before, self.h_right, (2.0 * c_left - fan) ** 2 / (9.0 * g))
        speed = np.where(before, 0.0, 2.0 * (fan + c_left) / 3.0)
        return h, speed * np.cos(self.angle), speed * np.sin(self.angle)
