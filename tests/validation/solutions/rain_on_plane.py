"""Rain on a long plane, with steady infiltration: a kinematic wave.

Source: Henderson and Wooding (1964), J. Geophys. Res. 69(8), 1531-1540; Woolhiser and Liggett (1967), Water
Resour. Res. 3(3), 753-771 (when the kinematic wave is good enough); Giraldez and Woolhiser (1996), Water
Resour. Res. 32(8), 2453-2465 (with infiltration, here at a constant rate).

Where the bed slope S alone balances friction, q = alpha h^m with alpha = sqrt(S) / n and m = 5/3, and ::

    dh/dt + d(alpha h^m)/dx = i - f        (i rain, f infiltration where there is water)

While it rains h = min((i - f) t, ((i - f) x / alpha)^(1/m)). After the end of the rain a point that starts at
x0 with h0 keeps h = h0 - f s after the time s and has come to x = x0 + alpha (h0^m - h^m) / f, or x0 + alpha
m h0^(m-1) s without infiltration. The full equations differ by about 1 / K, K = S length / (h froude^2).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
POWER = 5.0 / 3.0


@dataclass(frozen=True)
class RainOnPlane:
    """A plane from the divide at 0 down to ``length`` [m]; ``rain`` [m/s] falls until ``rain_end`` [s]."""

    length: float
    slope: float
    manning_n: float
    rain: float
    rain_end: float
    infiltration: float = 0.0
    gravity: float = 9.81

    @property
    def alpha(self) -> float:
        """Discharge of one metre of depth [m^(1/3)/s]."""
        return float(np.sqrt(self.slope) / self.manning_n)

    @property
    def excess(self) -> float:
        """Rain that runs off [m/s]."""
        return self.rain - self.infiltration

    @property
    def concentration_time(self) -> float:
        """Time after which the whole plane contributes [s]."""
        return float((self.length / (self.alpha * self.excess ** (POWER - 1.0))) ** (1.0 / POWER))

    @property
    def kinematic_number(self) -> float:
        """K at the foot in equilibrium [1]."""
        h = (self.excess * self.length / self.alpha) ** (1.0 / POWER)
        speed = self.alpha * h ** (POWER - 1.0)
        return float(self.slope * self.length * self.gravity / speed**2)

    def bed(self, x: Array, y: Array) -> Array:
        """Bed elevation [m]."""
        return self.slope * (self.length - x) + 0.0 * y

    def _rising(self, x: Array, time: float) -> Array:
        return np.minimum(self.excess * time, (self.excess * x / self.alpha) ** (1.0 / POWER))

    def _falling(self, x: Array, since: float) -> Array:
        """Depth ``since`` the end of the rain [s]; the foot of each characteristic is found by bisection."""
        low, high = np.zeros(x.shape), x.copy()
        for _ in range(60):
            foot = 0.5 * (low + high)
            start = self._rising(foot, self.rain_end)
            left = np.maximum(start - self.infiltration * since, 0.0)
            if self.infiltration > 0.0:
                way = (start**POWER - left**POWER) / self.infiltration
            else:
                way = POWER * start ** (POWER - 1.0) * since
            short = foot + self.alpha * way < x
            low, high = np.where(short, foot, low), np.where(short, high, foot)
        return left

    def state(self, x: Array, y: Array, time: float) -> tuple[Array, Array, Array]:
        """Depth [m] and velocity [m/s] on a plane that is dry at time 0."""
        x = np.broadcast_to(x, np.broadcast(x, y).shape).astype(np.float64)
        late = time > self.rain_end
        h = self._falling(x, time - self.rain_end) if late else self._rising(x, time)
        return h, self.alpha * h ** (POWER - 1.0), np.zeros(x.shape)

    def outflow(self, time: Array) -> Array:
        """Unit discharge at the foot [m2/s]."""
        foot = np.array([self.length])
        depths = [self.state(foot, foot, float(t))[0][0] for t in time]
        return self.alpha * np.array(depths) ** POWER
