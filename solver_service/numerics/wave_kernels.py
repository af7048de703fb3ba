"""The fastest wave on the grid and its cell, found on the device."""

import warp as wp

from solver_service.numerics.friction import GRAVITY
from solver_service.numerics.warp_modules import SUPPORT_MODULE

SPAN = wp.constant(64)
"""Cells of a row that one thread looks at."""

NOT_A_SPEED = wp.constant(3.0e38)
"""Wave speed of a cell whose state is not finite [m/s]."""


@wp.func
def wave_speed(h: float, u: float, v: float) -> float:
    """max(|u|, |v|) + c [m/s], huge where the state is not finite."""
    wave = wp.max(wp.abs(u), wp.abs(v)) + wp.sqrt(GRAVITY * h)
    return wp.where(wave + wp.abs(u) + wp.abs(v) < 1.0e30, wave, NOT_A_SPEED)


@wp.kernel(module=SUPPORT_MODULE)
def find_fastest_cell(
    h: wp.array2d(dtype=wp.float32),
    u: wp.array2d(dtype=wp.float32),
    v: wp.array2d(dtype=wp.float32),
    nrows: int,
    ncols: int,
    # outputs
    fastest: wp.array(dtype=wp.int64),
):
    """Raise `fastest` to (bits of the wave speed, cells after it): order-free, the first of equals wins.

    Args:
        h: depth [m], padded.
        u: velocity [m/s], padded.
        v: velocity [m/s], padded.
        nrows: grid rows.
        ncols: grid columns.
        fastest: [1], set to -1 before.
    """
    row, span = wp.tid()
    best = wp.int64(-1)
    for col in range(span * SPAN, wp.min((span + 1) * SPAN, ncols)):
        wave = wave_speed(h[row + 2, col + 2], u[row + 2, col + 2], v[row + 2, col + 2])
        after = nrows * ncols - 1 - (row * ncols + col)
        # Waves are not negative: their bits are ordered as they are.
        found = (wp.int64(wp.cast(wave, wp.int32)) << wp.int64(32)) | wp.int64(after)
        best = wp.max(best, found)
    wp.atomic_max(fastest, 0, best)
