"""Steady flow over a bump without friction: subcritical, transcritical, transcritical with a jump.

Source: Goutal and Maurel (1997), "Proceedings of the 2nd Workshop on Dam-Break Wave Simulation", EDF;
Delestre et al. (2013), SWASHES, sections 3.1.3 to 3.1.5.

The bed is z_b = 0.2 - 0.05 (x - 10)^2 for 8 < x < 12, else 0, in a channel of 25 m. The discharge q is the
same everywhere and the head E = z_b + h + q^2 / (2 g h^2) is kept between jumps, so that the depth is a root
of ::

    h^3 - (E - z_b) h^2 + q^2 / (2 g) = 0

the larger one where the flow is subcritical. Where it passes the crest with the critical depth h_c, E =
z_b(10) + 3 h_c / 2. A jump stands where the depths on its sides have the same momentum q^2 / h + g h^2 / 2.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

Array = NDArray[np.float64]
CREST = 10.0


@dataclass(frozen=True)
class Bump:
    """Unit ``discharge`` [m2/s]; ``depth_out`` [m] at the eastern end, unless the flow leaves it fast."""

    regime: Literal["subcritical", "transcritical", "jump"]
    discharge: float
    depth_out: float
    gravity: float = 9.81

    @property
    def length(self) -> float:
        """Length of the channel [m]."""
        return 25.0

    @property
    def critical_depth(self) -> float:
        """Depth at which the Froude number is 1 [m]."""
        return float((self.discharge**2 / self.gravity) ** (1.0 / 3.0))

    def bed(self, x: Array, y: Array) -> Array:
        """Bed elevation [m]."""
        return np.maximum(0.2 - 0.05 * (x - CREST) ** 2, 0.0) + 0.0 * y

    def _depth(self, energy: float, x: Array, fast: bool) -> Array:
        """The sub- or supercritical depth [m] with the head ``energy`` [m], by trisecting an angle."""
        above = energy - self.bed(x, 0.0 * x)
        angle = np.arccos(np.clip(1.0 - 6.75 * self.discharge**2 / (self.gravity * above**3), -1.0, 1.0))
        return above / 3.0 * (1.0 + 2.0 * np.cos((angle - 2.0 * np.pi * fast) / 3.0))

    @cached_property
    def heads(self) -> tuple[float, float]:
        """Head [m] above the crest, and at the eastern end if the flow is slow there."""
        crest = 0.2 + 1.5 * self.critical_depth
        outlet = self.depth_out + 0.5 * self.discharge**2 / (self.gravity * self.depth_out**2)
        return (outlet if self.regime == "subcritical" else crest), outlet

    @cached_property
    def jump(self) -> float:
        """Place of the jump [m]; infinite without one."""
        if self.regime != "jump":
            return np.inf

        def push(h: Array) -> float:
            return float(self.discharge**2 / h + 0.5 * self.gravity * h * h)

        def mismatch(at: float) -> float:
            x, (crest, outlet) = np.array(at), self.heads
            return push(self._depth(crest, x, fast=True)) - push(self._depth(outlet, x, fast=False))

        # Nearer to the crest the head of the outlet does not carry the discharge.
        first = CREST + np.sqrt(20.0 * (0.2 - self.heads[1] + 1.5 * self.critical_depth))
        return float(brentq(mismatch, first, CREST + 2.0, xtol=1e-12))

    def state(self, x: Array, y: Array, time: float) -> tuple[Array, Array, Array]:
        """Depth [m] and velocity [m/s], the same at every time."""
        x = np.broadcast_to(x, np.broadcast(x, y).shape)
        crest, outlet = self.heads
        h = self._depth(crest, x, fast=False)
        if self.regime != "subcritical":
            h = np.where(x > CREST, self._depth(crest, x, fast=True), h)
            h = np.where(x > self.jump, self._depth(outlet, x, fast=False), h)
        return h, self.discharge / h, np.zeros(x.shape)
