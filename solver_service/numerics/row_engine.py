"""Steps by SIMD row loops on the threads of a CPU.

The active tiles are cut into chunks, the chunks dealt to the threads in equal shares, and each thread sweeps its own with
one native call that holds no Python lock. The clock stays on the host. The result does not depend on how the tiles are
cut or dealt.
"""

from __future__ import annotations

import functools
import logging
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import numpy.typing as npt
import warp as wp

from solver_service.errors import DeviceError
from solver_service.numerics.active_tiles import REFRESH_STEPS
from solver_service.numerics.chunks import cut_chunks, deal_chunks
from solver_service.numerics.clock_kernels import (
    CLOCK_BEFORE,
    CLOCK_LENGTH,
    CLOCK_TIME,
    choose_dt,
)
from solver_service.numerics.device import warm_kernels
from solver_service.numerics.engine import Engine, StepCollapse, StepParts, StopQuestion
from solver_service.numerics.ghost_kernels import fill_ghost_cells, ghost_cells
from solver_service.numerics.row_kernels import CHUNK_COLS, SCRATCH_ROWS, step_chunks

LOG = logging.getLogger(__name__)

SCRATCH_PITCH = CHUNK_COLS + 16


@functools.cache
def rows_compile() -> bool:
    """Whether the native row loops compile here; says so once when they do not."""
    try:
        warm_kernels("cpu")
    except (DeviceError, RuntimeError) as error:
        LOG.warning("the SIMD row loops do not compile, the scalar kernels are used instead: %s", error)
        return False
    return True


class RowEngine(Engine):
    """See the module.

    Args:
        parts: what a step works on.
        threads: threads that step.
    """

    def __init__(self, parts: StepParts, threads: int) -> None:
        super().__init__(parts)
        store = parts.store
        self._threads = threads
        self._pool = ThreadPoolExecutor(threads - 1, "rows") if threads > 1 else None
        self._clock = wp.zeros(CLOCK_LENGTH, dtype=wp.float64, device="cpu")
        self._kinds = wp.array(parts.edge_kinds, dtype=wp.int32, device="cpu")
        self._all_ghosts = ghost_cells(store.nrows, store.ncols)
        self._scratch_size = SCRATCH_ROWS * SCRATCH_PITCH
        self._scratch = wp.zeros(threads * self._scratch_size, dtype=wp.float32, device="cpu")
        self._steps_to_refresh = 0
        self._mask: npt.NDArray[np.bool_] | None = None
        self._launches: tuple[list[wp.Launch], list[wp.Launch]] = ([], [])
        self._ghost_launches: list[wp.Launch] = []
        self._waves = np.zeros(0, np.float32)

    def state_changed(self) -> None:
        """Refresh every tile before the next step."""
        self.parts.tiles.reset()
        self._steps_to_refresh = 0

    def advance(self, target: float, should_stop: StopQuestion | None) -> bool:
        """See `Engine.advance`; `should_stop` is asked before every step."""
        while self.time < target:
            if should_stop is not None and should_stop():
                return False
            self._step(target)
        return True

    def _step(self, target: float) -> None:
        parts = self.parts
        store = parts.store
        dt, after, stable = choose_dt(self.time, target, self.wave_speed, parts.courant, parts.dt_max)
        if stable < parts.dt_min:
            raise StepCollapse
        if self._steps_to_refresh == 0:
            self._refresh()
        self._steps_to_refresh -= 1
        parity = store.parity
        self._ghost_launches[parity].launch()
        launches = self._launches[parity]
        for launch in launches:
            launch.set_param_at_index(7, dt)
            launch.set_param_at_index(8, after)
        futures = [self._pool.submit(launch.launch) for launch in launches[1:]] if self._pool else []
        if launches:
            launches[0].launch()
        for future in futures:
            future.result()
        before, self.time, self.dt = self.time, after, dt
        self.step_count += 1
        self.wave_speed = float(self._waves.max()) if self._waves.size else 0.0
        fields = store.fields[parity]
        store.parity = 1 - parity
        if parts.forcing.series_count or parts.gauges.is_due(after):
            clock = self._clock.numpy()
            clock[int(CLOCK_BEFORE)], clock[int(CLOCK_TIME)] = before, after
            parts.forcing.apply(self._clock, fields)
            if parts.gauges.is_due(after):
                parts.gauges.record(self._clock, fields)
                parts.gauges.drain()

    def _refresh(self) -> None:
        """Renew the tile list, and the launches when it changed."""
        parts = self.parts
        parts.tiles.refresh(parts.store.fields[parts.store.parity])
        self._steps_to_refresh = REFRESH_STEPS
        mask = parts.tiles.mask()
        if self._mask is not None and np.array_equal(mask, self._mask):
            return
        self._mask = mask
        store = parts.store
        chunks = cut_chunks(mask, store.nrows, store.ncols, self._threads, CHUNK_COLS)
        shares = deal_chunks(chunks, self._threads)
        chunk_array = wp.array(chunks.ravel(), dtype=wp.int32, device="cpu")
        waves = wp.zeros(len(chunks), dtype=wp.float32, device="cpu")
        self._waves = waves.numpy()
        self._launches = (
            self._record(0, chunk_array, shares, waves),
            self._record(1, chunk_array, shares, waves),
        )
        self._ghost_launches = [self._record_ghosts(parity) for parity in (0, 1)]

    def _record(
        self, parity: int, chunk_array: wp.array, shares: list[tuple[int, int]], waves: wp.array
    ) -> list[wp.Launch]:
        launches = []
        for thread, (first, last) in enumerate(shares):
            launches.append(
                wp.launch(
                    step_chunks,
                    dim=last - first,
                    inputs=[
                        self.parts.store.fields[parity],
                        self.parts.scheme,
                        chunk_array,
                        first,
                        self._scratch,
                        thread * self._scratch_size,
                        SCRATCH_PITCH,
                        0.0,
                        0.0,
                    ],
                    outputs=[waves],
                    device="cpu",
                    record_cmd=True,
                )
            )
        return launches

    def _record_ghosts(self, parity: int) -> wp.Launch:
        store = self.parts.store
        fields = store.fields[parity]
        ghosts = wp.array(self._all_ghosts, dtype=wp.int32, device="cpu")
        return wp.launch(
            fill_ghost_cells,
            dim=ghosts.shape[0],
            inputs=[self._kinds, ghosts, store.nrows, store.ncols],
            outputs=[fields.h, fields.u, fields.v],
            device="cpu",
            record_cmd=True,
        )
