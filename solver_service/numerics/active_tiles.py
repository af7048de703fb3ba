"""The list of compute tiles that can change, so that dry land costs nothing; see `tile_kernels` for the rule."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import warp as wp

from solver_service.numerics.fields import TILE, Fields, FieldStore
from solver_service.numerics.tile_kernels import classify_tiles, list_active_tiles

REFRESH_STEPS = 16
"""Steps for which a list stays valid; less than the cells on a tile's side, and even (see `kernel_engine`)."""


class ActiveTiles:
    """Which tiles are computed.

    Args:
        store: rasters of the run.
        depth_film: depth [m] that does not move by itself.
        forced: cells that may get water from outside, [nrows, ncols]; their tiles and those
            around them are always active.
    """

    def __init__(self, store: FieldStore, depth_film: float, forced: npt.NDArray[np.bool_]) -> None:
        self._store = store
        self._depth_film = depth_film
        self.rows = -(-store.nrows // TILE)
        self.cols = -(-store.ncols // TILE)
        count = self.rows * self.cols
        rows, cols = np.nonzero(forced)
        forced_tiles = np.zeros(count, np.int32)
        forced_tiles[(rows // TILE) * self.cols + cols // TILE] = 1
        self._forced = wp.array(forced_tiles, dtype=wp.int32, device=store.device)
        self._wet = wp.zeros(count, dtype=wp.int32, device=store.device)
        self.active = wp.zeros(count, dtype=wp.int32, device=store.device)
        self.tiles = wp.zeros(count, dtype=wp.int32, device=store.device)
        self.count = wp.zeros(1, dtype=wp.int32, device=store.device)

    def reset(self) -> None:
        """Look at every tile at the next refresh."""
        self.active.fill_(1)

    def refresh(self, fields: Fields) -> None:
        """Renew the list from the state `h`, `u`, `v` of `fields`."""
        store = self._store
        wp.launch(
            classify_tiles,
            dim=self._wet.shape[0],
            inputs=[fields.h, self._depth_film, store.nrows, store.ncols, self.cols, self.active],
            outputs=[self._wet, self.count],
            device=store.device,
        )
        wp.launch(
            list_active_tiles,
            dim=self._wet.shape[0],
            inputs=[
                fields.h,
                fields.u,
                fields.v,
                self._wet,
                self._forced,
                store.nrows,
                store.ncols,
                self.rows,
                self.cols,
            ],
            outputs=[fields.h_out, fields.u_out, fields.v_out, self.active, self.tiles, self.count],
            device=store.device,
        )

    def mask(self) -> npt.NDArray[np.bool_]:
        """Active tiles, [tile rows, tile columns]."""
        return self.active.numpy().reshape(self.rows, self.cols) == 1
