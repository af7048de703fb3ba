"""What leaves the device for a frame: quantised depth, velocity, maxima; a kernel or two and a copy each."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import warp as wp

from solver_service.numerics.channel_kernels import gather_maxima, gather_velocity
from solver_service.numerics.fields import FieldStore
from solver_service.numerics.wet_block_kernels import BLOCK_STRIDE, classify_blocks, quantise_depth


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


def read_velocity(store: FieldStore, depth_wet: float) -> npt.NDArray[np.float32]:
    """Velocity, [2, nrows, ncols]; see `gather_velocity`."""
    return _gather(gather_velocity, [store.current(name) for name in "huv"], 2, store, depth_wet)


def read_maximum_fields(store: FieldStore, depth_wet: float) -> npt.NDArray[np.float32]:
    """Maxima, [4, nrows, ncols]; see `gather_maxima`."""
    names = ("h_max", "speed_max", "hazard_max", "arrival")
    arrays = [store.current("h"), *(store.arrays[name] for name in names)]
    return _gather(gather_maxima, arrays, 4, store, depth_wet)


def _gather(
    kernel: wp.Kernel, arrays: list[wp.array], count: int, store: FieldStore, depth_wet: float
) -> npt.NDArray[np.float32]:
    shape = (store.nrows, store.ncols)
    gathered = wp.empty((count, *shape), dtype=wp.float32, device=store.device)
    wp.launch(kernel, dim=shape, inputs=[*arrays, depth_wet], outputs=[gathered], device=store.device)
    return np.array(gathered.numpy())
