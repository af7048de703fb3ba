"""What leaves the device for a frame: quantised depth, velocity, maxima; a kernel or two and a copy each.

What the host can do with a copy it does later and elsewhere: the solver waits for the copy alone.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import warp as wp

from solver_service.numerics.channel_kernels import gather_maxima, gather_velocity
from solver_service.numerics.fields import FieldStore
from solver_service.numerics.wet_block_kernels import BLOCK_STRIDE, classify_blocks, quantise_depth

MAXIMUM_NAMES = ("h_max", "speed_max", "hazard_max", "arrival")


def read_quantised(
    store: FieldStore, scale: float, depth_wet: float
) -> tuple[npt.NDArray[np.uint16], npt.NDArray[np.uint8]]:
    """Fixed-point depth [nrows, ncols] and block states [block_rows, block_cols]; see `wet_block_kernels`."""
    shape, device = (store.nrows, store.ncols), store.device
    blocks = tuple(max(1, -(-(n - 1) // BLOCK_STRIDE)) for n in shape)
    q = wp.empty(shape, dtype=wp.uint16, device=device)
    states = wp.empty(blocks, dtype=wp.uint8, device=device)
    wp.launch(
        quantise_depth, dim=shape, inputs=[store.current("h"), scale, depth_wet], outputs=[q], device=device
    )
    wp.launch(classify_blocks, dim=blocks, inputs=[q], outputs=[states], device=device)
    return q.numpy().copy(), states.numpy().copy()


def read_velocity(store: FieldStore) -> npt.NDArray[np.float32]:
    """Velocity to the east and north [m/s], [2, nrows, ncols]."""
    if store.device == "cpu":
        return np.stack([store.interior("u"), store.interior("v")])
    return gathered(gather_velocity, [store.current("u"), store.current("v")], 2, store)


def read_maximum_fields(store: FieldStore) -> npt.NDArray[np.float32]:
    """Largest depth [m], speed [m/s] and hazard, first arrival [s, `NEVER` where it has not come]."""
    if store.device == "cpu":
        fields = np.stack([store.interior(name) for name in MAXIMUM_NAMES])
        np.maximum(fields[0], store.interior("h"), out=fields[0])  # see `gather_maxima`
        return fields
    arrays = [store.current("h"), *(store.arrays[name] for name in MAXIMUM_NAMES)]
    return gathered(gather_maxima, arrays, len(MAXIMUM_NAMES), store)


def gathered(
    kernel: wp.Kernel, arrays: list[wp.array], count: int, store: FieldStore
) -> npt.NDArray[np.float32]:
    """What a kernel gathers from padded arrays, as an array of the host, [count, nrows, ncols]."""
    shape = (store.nrows, store.ncols)
    fields = wp.empty((count, *shape), dtype=wp.float32, device=store.device)
    wp.launch(kernel, dim=shape, inputs=arrays, outputs=[fields], device=store.device)
    return np.array(fields.numpy())
