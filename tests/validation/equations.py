"""The shallow-water equations by central differences: what exact solutions must satisfy."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def residual(solution, x: Array, y: Array, time: float, step: float = 1e-3) -> float:
    """Largest residual of the equations, each relative to its largest term.

    Terms that are rounding, such as the divergence of a discharge that is the same everywhere, count as 1e-6.
    A solution may carry ``manning_n`` [s m^(-1/3)] and ``rain`` [m/s], which falls without momentum.
    """
    g = solution.gravity
    manning_n, rain = getattr(solution, "manning_n", 0.0), getattr(solution, "rain", 0.0)

    def terms(x: Array, y: Array, time: float) -> Array:
        h, u, v = solution.state(x, y, time)
        return np.array(
            [h, h * u, h * v, h * u * u + 0.5 * g * h * h, h * u * v, h * v * v + 0.5 * g * h * h]
        )

    def slope(along: tuple[int, int, int]) -> Array:
        sx, sy, st = np.array(along) * step
        return (terms(x + sx, y + sy, time + st) - terms(x - sx, y - sy, time - st)) / (2.0 * step)

    dt, dx, dy = slope((0, 0, 1)), slope((1, 0, 0)), slope((0, 1, 0))
    h, u, v = solution.state(x, y, time)
    zx = (solution.bed(x + step, y) - solution.bed(x - step, y)) / (2.0 * step)
    zy = (solution.bed(x, y + step) - solution.bed(x, y - step)) / (2.0 * step)
    drag = g * manning_n**2 * np.hypot(u, v) * h ** (-1.0 / 3.0)
    equations = (
        (dt[0], dx[1], dy[2], np.full(h.shape, -rain)),
        (dt[1], dx[3], dy[4], g * h * zx, drag * u),
        (dt[2], dx[4], dy[5], g * h * zy, drag * v),
    )
    return max(
        float(np.abs(sum(parts)).max() / max(1e-6, *(np.abs(part).max() for part in parts)))
        for parts in equations
    )
