"""What a run keeps of a frame beside its depth, gathered on a device so that one copy is enough."""

import warp as wp

from solver_service.numerics.warp_modules import SUPPORT_MODULE


@wp.kernel(module=SUPPORT_MODULE)
def gather_velocity(
    u: wp.array2d(dtype=wp.float32),
    v: wp.array2d(dtype=wp.float32),
    # outputs
    velocity: wp.array3d(dtype=wp.float32),
):
    """Velocity to the east and north [m/s], [2, nrows, ncols]; inputs are padded."""
    row, col = wp.tid()
    velocity[0, row, col] = u[row + 2, col + 2]
    velocity[1, row, col] = v[row + 2, col + 2]


@wp.kernel(module=SUPPORT_MODULE)
def gather_maxima(
    h: wp.array2d(dtype=wp.float32),
    h_max: wp.array2d(dtype=wp.float32),
    speed_max: wp.array2d(dtype=wp.float32),
    hazard_max: wp.array2d(dtype=wp.float32),
    arrival: wp.array2d(dtype=wp.float32),
    # outputs
    maxima: wp.array3d(dtype=wp.float32),
):
    """Largest depth, speed and hazard, and first arrival, [4, nrows, ncols]; inputs are padded."""
    row, col = wp.tid()
    i = row + 2
    j = col + 2
    maxima[0, row, col] = wp.max(h_max[i, j], h[i, j])  # rain and sources raise the water after the step
    maxima[1, row, col] = speed_max[i, j]
    maxima[2, row, col] = hazard_max[i, j]
    maxima[3, row, col] = arrival[i, j]
