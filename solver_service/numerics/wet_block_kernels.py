"""Depths as 16-bit fixed point and the state of each output block, on the device.

    q = 0 if h < depth_wet, else min(max(1, round(h / scale)), 65535)

A block has up to 33 x 33 vertices, the shared edges included: DRY (0) when no q is positive, WET (2) when
all are, else PARTIAL (1). The division is float32 and halves round to even, as on the other side of the
wire.
"""

import warp as wp

from solver_service.numerics.warp_modules import SUPPORT_MODULE

BLOCK_STRIDE = 32
"""Vertices from one output block to the next."""


@wp.kernel(module=SUPPORT_MODULE)
def quantise_depth(
    h: wp.array2d(dtype=wp.float32),
    scale: float,
    depth_wet: float,
    # outputs
    q: wp.array2d(dtype=wp.uint16),
):
    """Fixed-point depth of every cell, [nrows, ncols]; `h` is padded."""
    row, col = wp.tid()
    depth = h[row + 2, col + 2]
    units = int(0)
    if depth >= depth_wet:
        units = int(wp.min(wp.max(wp.rint(depth / scale), 1.0), 65535.0))
    q[row, col] = wp.uint16(units)


@wp.kernel(module=SUPPORT_MODULE)
def classify_blocks(
    q: wp.array2d(dtype=wp.uint16),
    # outputs
    states: wp.array2d(dtype=wp.uint8),
):
    """State of every block, [block_rows, block_cols]."""
    block_row, block_col = wp.tid()
    row1 = wp.min(block_row * 32 + 33, q.shape[0])
    col1 = wp.min(block_col * 32 + 33, q.shape[1])
    any_wet = int(0)
    any_dry = int(0)
    for i in range(block_row * 32, row1):
        for j in range(block_col * 32, col1):
            if q[i, j] > wp.uint16(0):
                any_wet = 1
            else:
                any_dry = 1
    states[block_row, block_col] = wp.uint8(any_wet * (2 - any_dry))
