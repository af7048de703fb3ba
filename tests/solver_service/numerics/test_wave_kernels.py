"""The wave speed as kernels see it."""

import numpy as np
import warp as wp

from solver_service.numerics.wave_kernels import find_fastest_cell


def code_of(h):
    found = wp.full(1, -1, dtype=wp.int64, device="cpu")
    padded = np.pad(np.asarray(h, np.float32), 2)
    state = [wp.array(part, dtype=wp.float32, device="cpu") for part in (padded, 0 * padded, 0 * padded)]
    nrows, ncols = np.shape(h)
    spans = -(-ncols // 64)
    wp.launch(
        find_fastest_cell, dim=(nrows, spans), inputs=[*state, nrows, ncols], outputs=[found], device="cpu"
    )
    return int(found.numpy()[0])


def test_a_code_orders_by_speed_and_then_by_place():
    slow, fast = np.zeros((2, 70)), np.zeros((2, 70))
    slow[1, 69], fast[0, 0] = 1.0, 2.0
    assert code_of(fast) > code_of(slow) > code_of(np.zeros((2, 70)))
    early = np.zeros((2, 70))
    early[0, 65] = 1.0
    assert code_of(early) > code_of(slow)
    assert code_of(slow) & 0xFFFFFFFF == 0
