"""What a run keeps of a frame beside its depth, gathered on the device into one array to copy."""

import warp as wp

from solver_service.numerics.fields import NEVER
from solver_service.numerics.warp_modules import SUPPORT_MODULE

_NEVER = wp.constant(wp.float32(NEVER))


@wp.kernel(module=SUPPORT_MODULE)
def gather_velocity(
    h: wp.array2d(dtype=wp.float32),
    u: wp.array2d(dtype=wp.float32),
    v: wp.array2d(dtype=wp.float32),
    depth_wet: float,
    # outputs
    velocity: wp.array3d(dtype=wp.float32),
):
    """Velocity to the east and north [m/s], [2, nrows, ncols], 0 below `depth_wet` [m]; inputs are padded."""
    row, col = wp.tid()
    wet = h[row + 2, col + 2] >= depth_wet
    velocity[0, row, col] = wp.where(wet, u[row + 2, col + 2], 0.0)
    velocity[1, row, col] = wp.where(wet, v[row + 2, col + 2], 0.0)


@wp.kernel(module=SUPPORT_MODULE)
def gather_maxima(
    h: wp.array2d(dtype=wp.float32),
    h_max: wp.array2d(dtype=wp.float32),
    speed_max: wp.array2d(dtype=wp.float32),
    hazard_max: wp.array2d(dtype=wp.float32),
    arrival: wp.array2d(dtype=wp.float32),
    depth_wet: float,
    # outputs
    maxima: wp.array3d(dtype=wp.float32),
):
    """Largest depth, speed, hazard and first arrival, [4, nrows, ncols]; inputs are padded.

    Cells never deeper than `depth_wet` [m] that no arrival was noted for are 0; never is infinity.
    """
    row, col = wp.tid()
    i = row + 2
    j = col + 2
    deepest = wp.max(h_max[i, j], h[i, j])  # rain and sources raise the water after the step
    come = arrival[i, j] < _NEVER
    reached = come or deepest >= depth_wet
    maxima[0, row, col] = wp.where(reached, deepest, 0.0)
    maxima[1, row, col] = wp.where(reached, speed_max[i, j], 0.0)
    maxima[2, row, col] = wp.where(reached, hazard_max[i, j], 0.0)
    maxima[3, row, col] = wp.where(come, arrival[i, j], wp.inf)
