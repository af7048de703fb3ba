"""Steady flow with friction in channels whose bed is made to fit a chosen depth.

Source: MacDonald, Baines, Nichols and Samuels (1997), "Analytic benchmark solutions for open-channel flows",
J. Hydraul. Eng. 123(11), 1041-1045; Delestre et al. (2013), SWASHES, sections 3.2 (Manning friction) and 3.3
(rain).

With the depth h(x), the rain R and the unit discharge q = q0 + R x the bed slope follows from the momentum::

    dz_b/dx = -(1 - q^2 / (g h^3)) dh/dx - 2 q R / (g h^2) - n^2 q^2 h^(-10/3),        z_b(length) = 0

A jump joins two profiles at a place where both have the same momentum q^2 / h + g h^2 / 2; the bed is
continuous there. The derivative of a profile is taken with an imaginary step, which is exact to the last
digit; the bed is integrated with four Gauss points a panel.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicHermiteSpline

Array = NDArray[np.float64]
Profile = Callable[[Array], Array]
GRAVITY = 9.81
SCALE = (4.0 / GRAVITY) ** (1.0 / 3.0)
"""Critical depth of 2 m2/s [m], the unit of all profiles but the undulating one."""

PANELS = 2000


@dataclass(frozen=True)
class MacDonald:
    """Depth ``profile`` [m] of x, ``beyond`` the ``jump`` [m] another one; ``discharge`` [m2/s] enters."""

    length: float
    discharge: float
    manning_n: float
    profile: Profile
    jump: float = np.inf
    beyond: Profile | None = None
    rain: float = 0.0
    gravity: float = GRAVITY

    def flow(self, x: Array) -> Array:
        """Unit discharge [m2/s]."""
        return self.discharge + self.rain * x

    def depth(self, x: Array) -> Array:
        """Depth [m]."""
        h = self.profile(x)
        return h if self.beyond is None else np.where(x < self.jump, h, self.beyond(x))

    def _slope(self, profile: Profile, x: Array) -> Array:
        """dz_b/dx on one side of the jump."""
        h, dh, q = profile(x), np.imag(profile(x + 1e-30j)) / 1e-30, self.flow(x)
        inertia = (1.0 - q * q / (self.gravity * h**3)) * dh
        drops = 2.0 * q * self.rain / (self.gravity * h * h)
        return -inertia - drops - self.manning_n**2 * q * q / h ** (10.0 / 3.0)

    def _reach(self, profile: Profile, west: float, east: float, z_east: float) -> CubicHermiteSpline:
        """Bed between two places, integrated from the eastern one."""
        nodes = np.linspace(west, east, PANELS + 1)
        points, weights = np.polynomial.legendre.leggauss(4)
        half = 0.5 * np.diff(nodes)[:, None]
        inside = nodes[:-1, None] + half * (points + 1.0)
        falls = (self._slope(profile, inside) * weights * half).sum(axis=1)
        z = np.concatenate([[0.0], np.cumsum(falls)])
        return CubicHermiteSpline(nodes, z - z[-1] + z_east, self._slope(profile, nodes))

    @cached_property
    def _reaches(self) -> tuple[CubicHermiteSpline, CubicHermiteSpline]:
        if self.beyond is None:
            whole = self._reach(self.profile, 0.0, self.length, 0.0)
            return whole, whole
        lower = self._reach(self.beyond, self.jump, self.length, 0.0)
        return self._reach(self.profile, 0.0, self.jump, float(lower(self.jump))), lower

    def bed(self, x: Array, y: Array) -> Array:
        """Bed elevation [m], 0 at the eastern end."""
        upper, lower = self._reaches
        return np.where(x < self.jump, upper(x), lower(x)) + 0.0 * y

    def state(self, x: Array, y: Array, time: float) -> tuple[Array, Array, Array]:
        """Depth [m] and velocity [m/s], the same at every time."""
        x = np.broadcast_to(x, np.broadcast(x, y).shape)
        h = self.depth(x)
        return h, self.flow(x) / h, np.zeros(x.shape)


def _jump_tail(x: Array) -> Array:
    """Depth below the jump of the long channel [m]."""
    terms = ((1, -0.348427), (2, 0.552264), (3, -0.55558))
    bends = sum(a * np.exp(-20.0 * k * (x / 1000.0 - 0.5)) for k, a in terms)
    return SCALE * (1.0 + bends + 0.8 * np.exp(x / 1000.0 - 1.0))


def _short_tail(x: Array) -> Array:
    """Depth below the jump of the short channel [m]."""
    r = x / 100.0 - 2.0 / 3.0
    return SCALE * (0.674202 * r**4 + 0.674202 * r**3 - 21.7112 * r**2 + 14.492 * r + 1.4305)


def _slow(x: Array) -> Array:
    return SCALE * (1.0 + 0.5 * np.exp(-16.0 * (x / 1000.0 - 0.5) ** 2))


def _fast(x: Array) -> Array:
    return SCALE * (1.0 - 0.2 * np.exp(-36.0 * (x / 1000.0 - 0.5) ** 2))


CHANNELS = {
    "subcritical": MacDonald(1000.0, 2.0, 0.033, _slow),
    "supercritical": MacDonald(1000.0, 2.5, 0.04, _fast),
    "sub- to supercritical": MacDonald(
        1000.0,
        2.0,
        0.0218,
        lambda x: SCALE * (1.0 - np.tanh(3.0 * (x / 1000.0 - 0.5)) / 3.0),
        jump=500.0,
        beyond=lambda x: SCALE * (1.0 - np.tanh(6.0 * (x / 1000.0 - 0.5)) / 6.0),
    ),
    "super- to subcritical": MacDonald(
        1000.0,
        2.0,
        0.0218,
        lambda x: SCALE * (0.9 - np.exp(-x / 250.0) / 6.0),
        jump=500.0,
        beyond=_jump_tail,
    ),
    "short, smooth transition": MacDonald(
        100.0, 2.0, 0.0328, lambda x: SCALE * (1.0 - (x - 50.0) / 200.0 + (x - 50.0) ** 2 / 30000.0)
    ),
    "short, transition and jump": MacDonald(
        100.0,
        2.0,
        0.0328,
        lambda x: SCALE * (4.0 / 3.0 - x / 100.0) - 0.009 * x * (x / 100.0 - 2.0 / 3.0),
        jump=200.0 / 3.0,
        beyond=_short_tail,
    ),
    "long and undulating": MacDonald(
        5000.0, 2.0, 0.03, lambda x: 1.125 + 0.25 * np.sin(10.0 * np.pi * x / 5000.0)
    ),
    "subcritical with rain": MacDonald(1000.0, 1.0, 0.033, _slow, rain=0.001),
    "supercritical with rain": MacDonald(1000.0, 2.5, 0.04, _fast, rain=0.001),
}
"""The channels of SWASHES, sections 3.2.1 to 3.2.3 and 3.3 (where two profiles meet without a jump, ``jump``
is the place where one takes over)."""
