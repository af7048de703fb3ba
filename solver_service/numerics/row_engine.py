"""Steps by SIMD row loops on the threads of a CPU.

The active tiles are cut into chunks, the chunks dealt to the threads in equal shares, and each thread
sweeps its own, then what slower threads have left, in one native call that holds no Python lock. The clock
stays on the host. The result does not depend on how the tiles are cut or dealt.
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
    CLOCK_DT,
    CLOCK_LENGTH,
    CLOCK_STABLE,
    CLOCK_TIME,
    choose_dt,
)
from solver_service.numerics.device import warm_kernels
from solver_service.numerics.engine import Engine, StepCollapse, StepParts, StopQuestion
from solver_service.numerics.ghost_kernels import ghost_cells, ghost_tiles
from solver_service.numerics.row_kernels import CHUNK_COLS, SCRATCH_ROWS, step_chunks

LOG = logging.getLogger(__name__)

SCRATCH_PITCH = CHUNK_COLS + 16

DT_PARAMETER, STABLE_PARAMETER, TIME_PARAMETER = 7, 8, 9
"""Places of `dt`, `stable` and `time` among the arguments of `step_chunks`."""


@functools.cache
def rows_compile() -> bool:
    """Whether the native row loops compile here; says so once when they do not."""
    try:
        warm_kernels("cpu")
    except DeviceError as error:
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
        self._clock_view = self._clock.numpy()
        self._all_ghosts = ghost_cells(store.nrows, store.ncols)
        self._scratch_size = SCRATCH_ROWS * SCRATCH_PITCH
        self._scratch = wp.zeros(threads * self._scratch_size, dtype=wp.float32, device="cpu")
        tile_limit = parts.tiles.rows * parts.tiles.cols
        self._chunks = wp.zeros(4 * tile_limit, dtype=wp.int32, device="cpu")
        self._waves = wp.zeros(tile_limit, dtype=wp.float32, device="cpu")
        self._ghosts = wp.zeros(self._all_ghosts.size, dtype=wp.int32, device="cpu")
        self._ghost_tiles = ghost_tiles(self._all_ghosts, store.nrows, store.ncols)
        self._mask: npt.NDArray[np.bool_] | None = None
        self._ghost_count = 0
        self._rest_wave = self._waking_wave = 0.0
        self._shares = wp.zeros(threads + 1, dtype=wp.int32, device="cpu")
        self._taken = wp.zeros(threads, dtype=wp.int32, device="cpu")
        self._taken_view, self._share_view = self._taken.numpy(), self._shares.numpy()
        self._chunk_waves = np.zeros(0, np.float32)
        self._refreshes = [parts.tiles.refresh(fields, record=True) for fields in store.fields]
        self._edge_wave = wp.zeros(1, dtype=wp.float32, device="cpu")
        self._edge_wave_view = self._edge_wave.numpy()
        self._ghost_launches = [
            parts.edges.fill(self._clock, fields, self._ghosts, self._edge_wave, record=True)
            for fields in store.fields
        ]
        self._sweeps = [
            [self._record_sweep(parity, thread) for thread in range(threads)] for parity in (0, 1)
        ]

    def advance(self, target: float, should_stop: StopQuestion | None) -> bool:
        """See `Engine.advance`; `should_stop` is asked whenever the tile list is renewed."""
        self.parts.tiles.begin_interval()
        while self.time < target:
            if should_stop is not None and should_stop():
                return False
            self._refresh()
            for _ in range(REFRESH_STEPS):
                if self.time < target:
                    self._step(target)
            self.parts.sections.drain()
        return True

    def _step(self, target: float) -> None:
        parts = self.parts
        store = parts.store
        wave = max(self.wave_speed, self._rest_wave, self._waking_wave)
        self._waking_wave = 0.0
        dt, after, stable = choose_dt(self.time, target, wave, parts.courant, parts.dt_max)
        if stable < parts.dt_min:
            raise StepCollapse
        parity = store.parity
        clock = self._clock_view
        places = [int(CLOCK_BEFORE), int(CLOCK_TIME), int(CLOCK_DT), int(CLOCK_STABLE)]
        clock[places] = self.time, after, dt, stable
        self._edge_wave_view[0] = 0.0
        if self._ghost_count:
            for launch in self._ghost_launches[parity]:
                launch.launch()
        sweeps = self._sweeps[parity][: len(self._chunk_waves)]
        self._taken_view[:] = self._share_view[:-1]
        for sweep in sweeps:
            sweep.set_param_at_index(DT_PARAMETER, dt)
            sweep.set_param_at_index(STABLE_PARAMETER, stable)
            sweep.set_param_at_index(TIME_PARAMETER, after)
        futures = [self._pool.submit(sweep.launch) for sweep in sweeps[1:]] if self._pool else []
        if sweeps:
            sweeps[0].launch()
        for future in futures:
            future.result()
        self.time, self.dt = after, dt
        self.step_count += 1
        self.wave_speed = max(
            float(self._chunk_waves.max()) if sweeps else 0.0, float(self._edge_wave_view[0])
        )
        fields = store.fields[parity]
        store.parity = 1 - parity
        parts.sections.record(self._clock, fields, parts.scheme)
        for part in parts.after_step:
            part.apply(self._clock, fields)
        if parts.gauges.is_due(after):
            parts.gauges.record(self._clock, fields)
            parts.gauges.drain()

    def _refresh(self) -> None:
        """Renew the tile list, and deal the work anew when it changed."""
        parts = self.parts
        store = parts.store
        for launch in self._refreshes[store.parity]:
            launch.launch()
        self._rest_wave, self._waking_wave = parts.tiles.rest_wave.numpy().tolist()
        mask = parts.tiles.mask()
        if self._mask is not None and np.array_equal(mask, self._mask):
            return
        self._mask = mask
        chunks = cut_chunks(mask, store.nrows, store.ncols, self._threads, CHUNK_COLS)
        self._share_view[:] = deal_chunks(chunks, self._threads)
        self._chunks.numpy()[: chunks.size] = chunks.ravel()
        self._chunk_waves = self._waves.numpy()[: len(chunks)]
        ghosts = self._all_ghosts[mask.ravel()[self._ghost_tiles]]
        self._ghost_count = ghosts.size
        self._ghosts.numpy()[: ghosts.size] = ghosts
        for parity in (0, 1):
            self._ghost_launches[parity][-1].set_dim(max(1, ghosts.size))

    def _record_sweep(self, parity: int, thread: int) -> wp.Launch:
        return wp.launch(
            step_chunks,
            dim=1,
            inputs=[
                self.parts.store.fields[parity],
                self.parts.scheme,
                self._chunks,
                thread,
                self._scratch,
                thread * self._scratch_size,
                SCRATCH_PITCH,
                0.0,
                0.0,
                0.0,
                self._shares,
            ],
            outputs=[self._taken, self._waves],
            device="cpu",
            record_cmd=True,
        )
