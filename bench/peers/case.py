"""The common case: a column of water collapses on a dry bumpy bed inside four walls.

A square of 5120 m; a column of 1500 m radius whose surface stands at 10 m; the bed 0.5 m with sines of
0.2 m; Manning n = 0.03; 100 s. The column's edge is a ramp of 10 m, so that the problem is the same on every
grid. Only NumPy is needed: every peer's own environment imports this file.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

SIDE = 5120.0
"""Length of the square [m]."""
RADIUS = 1500.0
"""Radius of the column [m]."""
SURFACE = 10.0
"""Surface of the column [m]."""
RAMP = 10.0
"""Width of the column's edge [m]."""
MANNING_N = 0.03
"""Roughness [s m^(-1/3)]."""
GRAVITY = 9.81
"""Gravity [m/s2]."""
END_TIME = 100.0
"""Time of the comparison [s]."""


def bed(x: Array, y: Array) -> Array:
    """Bed elevation [m] at coordinates from 0 to `SIDE` [m]."""
    return 0.5 + 0.2 * np.sin(x / 60.0) * np.cos(y / 45.0)


def depth(x: Array, y: Array) -> Array:
    """Depth at the start [m]."""
    radius = np.hypot(x - 0.5 * SIDE, y - 0.5 * SIDE)
    return np.clip((RADIUS - radius) / RAMP + 0.5, 0.0, 1.0) * (SURFACE - bed(x, y))


def centres(cells: int) -> tuple[Array, Array]:
    """Coordinates x and y of the centres of `cells` x `cells` cells [m], [row, col], row 0 in the south."""
    along = (np.arange(cells) + 0.5) * (SIDE / cells)
    x, y = np.meshgrid(along, along)
    return x, y


def save(
    path: str,
    fields: tuple[Array, Array, Array],
    volumes: tuple[float, float],
    steps: int,
    seconds: tuple[float, float],
    version: str,
) -> None:
    """Write what a run has computed.

    Args:
        path: file to write.
        fields: depth [m] and both unit discharges [m2/s] on the grid, NaN where the solver keeps none.
        volumes: water at the start and at the end on the solver's own grid, in any unit.
        steps: full time steps.
        seconds: CPU and wall time of the time loop [s].
        version: the solver's version.
    """
    h, hu, hv = fields
    change = volumes[1] / volumes[0] - 1.0
    cpu, wall = seconds
    kept = {"steps": steps, "cpu_s": cpu, "wall_s": wall, "volume_error": change, "version": version}
    np.savez(path, h=h, hu=hu, hv=hv, **kept)
