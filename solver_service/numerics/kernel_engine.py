"""Steps by Warp kernels alone: the engine of CUDA devices, and the oracle of the row engine on the CPU.

Four steps follow one refresh of the tile list; this body is repeated while the device's own clock is short
of the target (`wp.capture_while`; on CUDA captured once as a graph, so that the host waits for nothing in
between). Steps after the landing find dt = 0 and copy the state, so that the body always ends in the buffer
it began with.

The graph runs to the target, unless somebody may want to stop before: then to a number of steps that takes
about `QUESTION_SECONDS`, as measured so far. Where a launch ends changes no bit of the result.
"""

from __future__ import annotations

import gc
import time

import numpy as np
import warp as wp

from solver_service.numerics.active_tiles import REFRESH_STEPS
from solver_service.numerics.clock_kernels import (
    CLOCK_BEFORE,
    CLOCK_LENGTH,
    CLOCK_TARGET,
    CLOCK_TIME,
    COUNT_FAILED,
    COUNT_LENGTH,
    COUNT_STEPS,
    begin_step,
    decide_to_go_on,
)
from solver_service.numerics.engine import Engine, StepCollapse, StepParts, StopQuestion
from solver_service.numerics.fields import Fields
from solver_service.numerics.ghost_kernels import ghost_cells
from solver_service.numerics.step_kernels import keep_class_arrivals, step_active_tiles
from solver_service.numerics.tile_list_kernels import decide_and_begin_list
from solver_service.numerics.tile_step_kernels import (
    BLOCKS_PER_MULTIPROCESSOR,
    HOST_MEMORY,
    LANES,
    step_listed_tiles,
)

WAVE_SLOTS = 16
"""Places of the largest wave speed: few, since one thread reads them all before every step."""

QUESTION_SECONDS = 0.05
"""Wall time after which `should_stop` is asked again, about."""

FIRST_STEPS = 64
"""Steps before it is asked for the second time, when nothing has been measured yet."""

CUDA_THREADS = 1 << 18
CPU_THREADS = 1


class KernelEngine(Engine):
    """See the module; state is always in buffer 0 between calls.

    Args:
        parts: what a step works on.
        by_tiles: whether thread blocks step whole tiles; else each thread steps single cells.
    """

    def __init__(self, parts: StepParts, by_tiles: bool) -> None:
        super().__init__(parts)
        self._by_tiles = by_tiles
        store = parts.store
        device = store.device
        self._device = device
        self._is_cuda = wp.get_device(device).is_cuda
        self._clock = wp.zeros(CLOCK_LENGTH, dtype=wp.float64, device=device)
        self._counts = wp.zeros(COUNT_LENGTH, dtype=wp.int32, device=device)
        self._go_on = wp.zeros(1, dtype=wp.int32, device=device)
        self._wave_slots = wp.zeros(WAVE_SLOTS, dtype=wp.float32, device=device)
        self._ghosts = wp.array(ghost_cells(store.nrows, store.ncols), dtype=wp.int32, device=device)
        self._threads = CUDA_THREADS if self._is_cuda else CPU_THREADS
        self._lanes = LANES if self._is_cuda else 1
        self._blocks = max(1, BLOCKS_PER_MULTIPROCESSOR * wp.get_device(device).sm_count)
        self._host_memory = wp.zeros(0 if self._is_cuda else HOST_MEMORY, dtype=wp.float32, device=device)
        self._graph: wp.Graph | None = None
        self._steps_between_questions = FIRST_STEPS

    def advance(self, target: float, should_stop: StopQuestion | None) -> bool:
        """See `Engine.advance`."""
        self._upload(target)
        self.parts.tiles.begin_interval()
        while self.time < target:
            recorders = (self.parts.gauges, self.parts.sections)
            limit = min(recorder.steps_with_room(target - self.time) for recorder in recorders)
            if should_stop is not None:
                if should_stop():
                    return False
                limit = min(limit, self._steps_between_questions)
            began, steps = time.perf_counter(), self.step_count
            self._launch_steps(limit)
            self._download()
            self._learn(self.step_count - steps, time.perf_counter() - began)
            self.parts.gauges.drain()
            self.parts.sections.drain()
        return True

    def _learn(self, steps: int, seconds: float) -> None:
        """Choose how many steps go between two questions, from how long the last ones took."""
        now = self._steps_between_questions
        self._steps_between_questions = max(
            REFRESH_STEPS, min(4 * now, round(QUESTION_SECONDS * steps / max(seconds, 1e-6)))
        )

    def _upload(self, target: float) -> None:
        clock = np.zeros(CLOCK_LENGTH)
        clock[[int(CLOCK_TIME), int(CLOCK_BEFORE), int(CLOCK_TARGET)]] = self.time, self.time, target
        self._clock.assign(clock)
        slots = np.zeros(WAVE_SLOTS, np.float32)
        slots[0] = self.wave_speed
        self._wave_slots.assign(slots)

    def _download(self) -> None:
        counts = self._counts.numpy()
        clock = self._clock.numpy()
        self.step_count += int(counts[int(COUNT_STEPS)])
        self.time = float(clock[int(CLOCK_TIME)])
        if counts[int(COUNT_FAILED)]:
            raise StepCollapse
        self.wave_speed = float(self._wave_slots.numpy().max())

    def _launch_steps(self, limit: int) -> None:
        self._counts.assign(np.array([0, limit, 0], np.int32))
        self._decide()
        if not self._is_cuda:
            wp.capture_while(self._go_on, self._take_steps)
        else:
            if self._graph is None:
                gc.collect()  # a collection on another thread would end the capture
                # Loading every module here would hand the native rows of CPUs to NVRTC; ours are loaded.
                with wp.ScopedCapture(device=self._device, force_module_load=False) as capture:
                    wp.capture_while(self._go_on, self._take_steps)
                self._graph = capture.graph
            wp.capture_launch(self._graph)

    def _decide(self) -> None:
        tiles = self.parts.tiles
        wp.launch(
            decide_and_begin_list if self._by_tiles else decide_to_go_on,
            dim=1,
            inputs=[self._clock, self._counts],
            outputs=[self._go_on]
            + ([tiles.is_first, tiles.count, tiles.rest_wave] if self._by_tiles else []),
            device=self._device,
            block_dim=self._lanes,
        )

    def _take_steps(self) -> None:
        fields = self.parts.store.fields[0]
        if self._by_tiles:
            self.parts.tiles.refresh_by_blocks(fields, self._blocks, self._lanes, self._host_memory)
        else:
            self.parts.tiles.refresh(fields)
        for k in range(REFRESH_STEPS):
            self._take_step(k % 2)
        self._decide()

    def _take_step(self, parity: int) -> None:
        parts, device = self.parts, self._device
        store = parts.store
        fields = store.fields[parity]
        wp.launch(
            begin_step,
            dim=1,
            inputs=[parts.courant, parts.dt_max, parts.dt_min],
            outputs=[parts.tiles.rest_wave, self._wave_slots, self._clock, self._counts],
            device=device,
        )
        parts.edges.fill(self._clock, fields, self._ghosts, self._wave_slots)
        self._step_tiles(fields)
        parts.sections.record(self._clock, fields, parts.scheme)
        for part in parts.after_step:
            part.apply(self._clock, fields)
        parts.gauges.record(self._clock, fields)

    def _step_tiles(self, fields: Fields) -> None:
        parts, tiles = self.parts, self.parts.tiles
        inputs = [fields, parts.scheme, self._clock, tiles.tiles, tiles.count, tiles.cols]
        if self._by_tiles:
            wp.launch(
                step_listed_tiles,
                dim=self._blocks * self._lanes,
                inputs=[*inputs, self._blocks, self._host_memory],
                outputs=[self._wave_slots],
                device=self._device,
                block_dim=self._lanes,
            )
        else:
            wp.launch(
                step_active_tiles,
                dim=self._threads,
                inputs=[*inputs, self._threads],
                outputs=[self._wave_slots],
                device=self._device,
            )
        if parts.store.arrival_depths:
            inputs = [*inputs, self._threads]
            wp.launch(keep_class_arrivals, dim=self._threads, inputs=inputs, device=self._device)
