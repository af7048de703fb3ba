"""Sources and rain of a model on its device; see `forcing_kernels` for how water is handed out."""

from __future__ import annotations

import math

import numpy as np
import warp as wp

from solver_service.numerics.fields import Fields, FieldStore
from solver_service.numerics.forcing_kernels import QUANTUM, add_rain, add_source_water, release_water
from solver_service.numerics.friction import GRAVITY
from solver_service.numerics.model import FloodModel

WAVE_FLOOR = 1.0
"""Wave speed that a step always allows for [m/s], so that the first water does not meet a giant step."""


class Forcing:
    """Hands out what enters the domain, and remembers how much.

    Args:
        model: the model whose sources and rain are applied.
        device: Warp device name.
    """

    def __init__(self, model: FloodModel, device: str) -> None:
        self.device = device
        self.shape = model.shape
        self.source_count = len(model.sources)
        self.has_rain = model.rain is not None
        self.series_count = self.source_count + int(self.has_rain)
        cell_area = model.dx * model.dx
        series = [(s.times, s.discharge, s.rows.size * cell_area) for s in model.sources]
        if model.rain is not None:
            series.append((*model.rain, 1.0))
        roof = np.zeros(model.shape, np.int8) if model.blocked is None else model.blocked.astype(np.int8)
        rained_cells = int(np.count_nonzero(roof == 0))
        self.cell_volumes = np.array(
            [QUANTUM * area for _, _, area in series[: self.source_count]]
            + [QUANTUM * cell_area * rained_cells] * int(self.has_rain)
        )
        self.dt_max = self._largest_step(model)
        if not series:
            return
        starts = np.cumsum([0, *(times.size for times, _, _ in series)])
        volumes = [
            np.concatenate([[0.0], np.cumsum(0.5 * (rates[1:] + rates[:-1]) * np.diff(times))])
            for times, rates, _ in series
        ]
        self._first = self._to_device(starts, wp.int32)
        self._times = self._to_device(np.concatenate([times for times, _, _ in series]), wp.float64)
        self._rates = self._to_device(np.concatenate([rates for _, rates, _ in series]), wp.float64)
        self._volumes = self._to_device(np.concatenate(volumes), wp.float64)
        self._areas = self._to_device(np.array([area for _, _, area in series]), wp.float64)
        self._released = wp.zeros(self.series_count, dtype=wp.float64, device=device)
        self._depths = wp.zeros(self.series_count, dtype=wp.float32, device=device)
        self._cells = [
            (self._to_device(s.rows, wp.int32), self._to_device(s.cols, wp.int32)) for s in model.sources
        ]
        self._roof = self._to_device(roof, wp.int8) if self.has_rain else None

    def _to_device(self, values: np.ndarray, dtype: type) -> wp.array:
        return wp.array(values, dtype=dtype, device=self.device)

    @staticmethod
    def _largest_step(model: FloodModel) -> float:
        """Largest step at Courant number 1 [s]: dx over the speed at which the largest inflow spreads."""
        speed = WAVE_FLOOR
        for source in model.sources:
            per_width = float(source.discharge.max()) / (math.sqrt(source.rows.size) * model.dx)
            speed = max(speed, 2.0 * (float(GRAVITY) * per_width) ** (1.0 / 3.0))
        return model.dx / speed

    def apply(self, clock: wp.array, fields: Fields) -> None:
        """Add to `h_out` of `fields` what is due at the clock's time."""
        if not self.series_count:
            return
        wp.launch(
            release_water,
            dim=self.series_count,
            inputs=[clock, self._first, self._times, self._rates, self._volumes, self._areas],
            outputs=[self._released, self._depths],
            device=self.device,
        )
        state = [fields.h_out, fields.u_out, fields.v_out]
        for k, (rows, cols) in enumerate(self._cells):
            wp.launch(
                add_source_water,
                dim=rows.shape[0],
                inputs=[k, self._depths, rows, cols],
                outputs=state,
                device=self.device,
            )
        if self.has_rain:
            wp.launch(
                add_rain,
                dim=self.shape,
                inputs=[self.source_count, self._depths, self._roof],
                outputs=state,
                device=self.device,
            )

    @property
    def released(self) -> np.ndarray:
        """Quanta handed out so far by each source, then by the rain, float64."""
        return self._released.numpy().copy() if self.series_count else np.zeros(0)

    @released.setter
    def released(self, quanta: np.ndarray) -> None:
        if self.series_count:
            self._released.assign(np.asarray(quanta, np.float64))

    def volumes(self) -> tuple[float, float]:
        """Volume that the sources and the rain have brought [m3]."""
        volumes = self.released * self.cell_volumes
        return float(volumes[: self.source_count].sum()), float(volumes[self.source_count :].sum())


def forced_cells(model: FloodModel, store: FieldStore) -> np.ndarray:
    """Mask of the cells that may get water from outside at any time, [nrows, ncols]."""
    mask = np.full((store.nrows, store.ncols), model.rain is not None)
    for source in model.sources:
        mask[source.rows, source.cols] = True
    return mask
