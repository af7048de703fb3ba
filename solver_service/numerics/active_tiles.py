"""The list of compute tiles that can change, so that dry land costs nothing; `tile_kernels` has the rule."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import warp as wp

from solver_service.numerics.fields import TILE, Fields, FieldStore
from solver_service.numerics.tile_kernels import classify_tiles, list_active_tiles
from solver_service.numerics.tile_list_kernels import list_tiles, scan_tiles

REFRESH_STEPS = 4
"""Steps for which a list stays valid: half a tile at two cells a step; even (see `kernel_engine`)."""


class ActiveTiles:
    """Which tiles are computed.

    Args:
        store: rasters of the run.
        depth_film: depth [m] that does not move by itself.
        is_wet_lively: whether water deeper than the film never sleeps, as where the ground drinks it.
    """

    def __init__(self, store: FieldStore, depth_film: float, is_wet_lively: bool = False) -> None:
        self._store = store
        self._depth_film = depth_film
        self._is_wet_lively = int(is_wet_lively)
        self.rows = -(-store.nrows // TILE)
        self.cols = -(-store.ncols // TILE)
        count = self.rows * self.cols
        self._forced = wp.zeros(count, dtype=wp.int32, device=store.device)
        self._quadrants = wp.zeros(count, dtype=wp.int32, device=store.device)
        self._tile_wave = wp.zeros(count, dtype=wp.float32, device=store.device)
        self.rest_wave = wp.zeros(2, dtype=wp.float32, device=store.device)
        self.is_first = wp.zeros(2, dtype=wp.int32, device=store.device)
        self.active = wp.zeros(count, dtype=wp.int32, device=store.device)
        self.tiles = wp.zeros(count, dtype=wp.int32, device=store.device)
        self.count = wp.zeros(3, dtype=wp.int32, device=store.device)

    def keep_awake(self, cells: npt.NDArray[np.bool_]) -> None:
        """Let the tiles of some cells, [nrows, ncols], and those around them never sleep."""
        rows, cols = np.nonzero(cells)
        forced = np.zeros(self.rows * self.cols, np.int32)
        forced[(rows // TILE) * self.cols + cols // TILE] = 1
        self._forced.assign(forced)

    def begin_interval(self) -> None:
        """Let the next list depend on the present state alone."""
        self.is_first.fill_(1)

    def refresh(self, fields: Fields, record: bool = False) -> list[wp.Launch]:
        """Renew the list from the state `h`, `u`, `v` of `fields`, or record the launches that do so."""
        store = self._store
        state = [fields.h, fields.u, fields.v]
        launches = [
            wp.launch(
                classify_tiles,
                dim=self.rows,
                inputs=[
                    *state,
                    fields.h_out,
                    self._depth_film,
                    self._is_wet_lively,
                    store.nrows,
                    store.ncols,
                    self.cols,
                    self.active,
                    self._forced,
                    self.is_first,
                ],
                outputs=[self._quadrants, self.count, self.rest_wave],
                device=store.device,
                record_cmd=record,
            ),
            wp.launch(
                list_active_tiles,
                dim=self.rows,
                inputs=[*state, self._quadrants, store.nrows, store.ncols, self.rows, self.cols],
                outputs=[
                    fields.h_out,
                    fields.u_out,
                    fields.v_out,
                    self.active,
                    self.tiles,
                    self.count,
                    self.is_first,
                    self._tile_wave,
                    self.rest_wave,
                ],
                device=store.device,
                record_cmd=record,
            ),
        ]
        return [launch for launch in launches if launch is not None]

    def refresh_by_blocks(self, fields: Fields, blocks: int, lanes: int, host_memory: wp.array) -> None:
        """As `refresh`, by thread blocks, after `decide_and_begin_list`; see `tile_list_kernels`.

        Args:
            fields: see `refresh`.
            blocks: thread blocks that look at tiles.
            lanes: threads of a block.
            host_memory: memory of a block on the CPU.
        """
        store = self._store
        wp.launch(
            scan_tiles,
            dim=blocks * lanes,
            inputs=[
                fields.h,
                fields.u,
                fields.v,
                fields.h_out,
                self._depth_film,
                self._is_wet_lively,
                store.nrows,
                store.ncols,
                self.rows,
                self.cols,
                self.tiles,
                self.count,
                self._forced,
                self.is_first,
                blocks,
                host_memory,
            ],
            outputs=[self._quadrants, self._tile_wave],
            device=store.device,
            block_dim=lanes,
        )
        wp.launch(
            list_tiles,
            dim=self.rows * self.cols,
            inputs=[self._quadrants, self._tile_wave, self.is_first, self.rows, self.cols],
            outputs=[self.active, self.tiles, self.count, self.rest_wave],
            device=store.device,
            block_dim=lanes,
        )

    def mask(self) -> npt.NDArray[np.bool_]:
        """Active tiles, [tile rows, tile columns]."""
        return self.active.numpy().reshape(self.rows, self.cols) == 1
