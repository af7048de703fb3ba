"""The cell whose wave decides the time step; cheap enough to be asked with every report of progress."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import warp as wp

from solver_service.numerics.fields import FieldStore
from solver_service.numerics.wave_kernels import SPAN, find_fastest_cell


@dataclass(frozen=True)
class FastestCell:
    """Where the fastest wave is."""

    wave: float
    """max(|u|, |v|) + c [m/s], huge where the state is not finite."""
    row: int
    """Grid row."""
    col: int
    """Grid column."""


def fastest_cell(store: FieldStore) -> FastestCell:
    """The cell with the fastest wave of the present state, the first of equals in reading order."""
    nrows, ncols = store.nrows, store.ncols
    found = wp.full(1, -1, dtype=wp.int64, device=store.device)
    wp.launch(
        find_fastest_cell,
        dim=(nrows, -(-ncols // int(SPAN))),
        inputs=[store.current("h"), store.current("u"), store.current("v"), nrows, ncols],
        outputs=[found],
        device=store.device,
    )
    code = int(found.numpy()[0])
    row, col = divmod(nrows * ncols - 1 - (code & 0xFFFFFFFF), ncols)
    wave = float(np.array(code >> 32, np.int32).view(np.float32))
    return FastestCell(wave, row, col)
