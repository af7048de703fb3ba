"""Sources and rain of a model on its device; see `forcing_kernels` for how water is handed out.

Each source is one series of the ledger, each rain cell another. The ledger holds the quanta of 2^-16 m that
each series has handed out so far.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import warp as wp

from solver_service.numerics.fields import Fields
from solver_service.numerics.forcing_kernels import QUANTUM, add_rain, add_source_water, release_water
from solver_service.numerics.friction import GRAVITY
from solver_service.numerics.joined_series import SeriesArrays, value_at
from solver_service.numerics.model import FloodModel
from solver_service.numerics.step_part import PartVolumes


@dataclass(frozen=True)
class _Series:
    """One entry of the ledger."""

    times: npt.NDArray[np.float64]
    rates: npt.NDArray[np.float64]
    is_stepped: bool
    area: float
    """Area that a rate of 1 is spread over [m2]; 1 for rain, whose rates are depths per time."""
    cell_count: int
    """Cells that get the depth handed out."""

    def volumes(self) -> npt.NDArray[np.float64]:
        """Integral of the rates from time 0 to each time."""
        mean = self.rates[:-1] if self.is_stepped else 0.5 * (self.rates[1:] + self.rates[:-1])
        volumes = np.concatenate([[0.0], np.cumsum(mean * np.diff(self.times))])
        last = int(np.searchsorted(self.times, 0.0, side="right")) - 1
        if last < 0:
            return volumes
        rate = value_at(SeriesArrays(self.times, self.rates), 0.0, self.is_stepped, holds_first=False)
        earlier = self.rates[last] if self.is_stepped else 0.5 * (self.rates[last] + float(rate))
        return volumes - (volumes[last] - earlier * self.times[last])


class Forcing:
    """Hands out what enters the domain, and remembers how much; a `StepPart`.

    Args:
        model: the model whose sources and rain are applied.
        cfl: Courant number of the scheme.
        device: Warp device name.
    """

    names = ("released",)

    def __init__(self, model: FloodModel, cfl: float, device: str) -> None:
        self.device = device
        self._shape = model.shape
        self._sources = model.sources
        self._source_ids = [source.id or f"source-{k}" for k, source in enumerate(model.sources, 1)]
        self._rain = model.rain
        self._cell_area = model.dx * model.dx
        self.dt_max = cfl * self._largest_step(model)
        roof = np.zeros(model.shape, np.int8) if model.blocked is None else model.blocked.astype(np.int8)
        series = [
            _Series(s.times, s.discharge, False, s.rows.size * self._cell_area, s.rows.size)
            for s in model.sources
        ] + self._rain_series(roof)
        self.series_count = len(series)
        self._cell_counts = np.array([s.cell_count for s in series], np.float64)
        self._first = self._to_device(np.cumsum([0, *(s.times.size for s in series)]), wp.int32)
        self._times = self._to_device(np.concatenate([s.times for s in series]), wp.float64)
        self._rates = self._to_device(np.concatenate([s.rates for s in series]), wp.float64)
        self._volumes = self._to_device(np.concatenate([s.volumes() for s in series]), wp.float64)
        self._areas = self._to_device(np.array([s.area for s in series]), wp.float64)
        self._stepped = self._to_device(np.array([s.is_stepped for s in series]), wp.int32)
        self._released = wp.zeros(self.series_count, dtype=wp.float64, device=device)
        self._depths = wp.zeros(self.series_count, dtype=wp.float32, device=device)
        self._rain_depths = self._depths.numpy()[len(model.sources) :] if device == "cpu" else None
        self._cells = [
            (self._to_device(s.rows, wp.int32), self._to_device(s.cols, wp.int32)) for s in model.sources
        ]
        if self._rain is not None:
            self._roof = self._to_device(roof, wp.int8)
            self._row_index = self._to_device(self._rain.row_index, wp.int32)
            self._col_index = self._to_device(self._rain.col_index, wp.int32)

    @staticmethod
    def is_needed(model: FloodModel) -> bool:
        """Whether the model has sources or rain."""
        return bool(model.sources) or model.rain is not None

    def _rain_series(self, roof: npt.NDArray[np.int8]) -> list[_Series]:
        rain = self._rain
        if rain is None:
            return []
        rain_rows, rain_cols = rain.rates.shape[1:]
        number = rain.row_index[:, None].astype(np.int64) * rain_cols + rain.col_index[None, :]
        counts = np.bincount(number[roof == 0], minlength=rain_rows * rain_cols)
        stepped = rain.interpolation == "step"
        return [
            _Series(rain.times, np.ascontiguousarray(rates), stepped, 1.0, int(count))
            for rates, count in zip(rain.rates.reshape(rain.times.size, -1).T, counts, strict=True)
        ]

    def _to_device(self, values: npt.NDArray, dtype: type) -> wp.array:
        return wp.array(values, dtype=dtype, device=self.device)

    @staticmethod
    def _largest_step(model: FloodModel) -> float:
        """Largest step at Courant number 1 [s]: dx over the speed at which the largest inflow spreads."""
        speed = 0.0
        for source in model.sources:
            per_width = float(source.discharge.max()) / (math.sqrt(source.rows.size) * model.dx)
            speed = max(speed, 2.0 * (float(GRAVITY) * per_width) ** (1.0 / 3.0))
        return model.dx / speed if speed > 0.0 else math.inf

    def cells(self) -> npt.NDArray[np.bool_]:
        """See `StepPart.cells`."""
        mask = np.full(self._shape, self._rain is not None)
        for source in self._sources:
            mask[source.rows, source.cols] = True
        return mask

    def begin(self) -> None:
        """See `StepPart.begin`."""
        self._released.zero_()

    def apply(self, clock: wp.array, fields: Fields) -> None:
        """Add to `h_out` of `fields` what is due at the clock's time."""
        wp.launch(
            release_water,
            dim=self.series_count,
            inputs=[
                clock,
                self._first,
                self._times,
                self._rates,
                self._volumes,
                self._areas,
                self._stepped,
            ],
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
        # Most steps of weak rain hand out no quantum; where the host sees the memory it spares the launch.
        if self._rain is not None and (self._rain_depths is None or self._rain_depths.any()):
            wp.launch(
                add_rain,
                dim=self._shape,
                inputs=[
                    len(self._sources),
                    self._rain.rates.shape[2],
                    self._depths,
                    self._row_index,
                    self._col_index,
                    self._roof,
                ],
                outputs=state,
                device=self.device,
            )

    def volumes(self) -> PartVolumes:
        """See `StepPart.volumes`."""
        volumes = self._released.numpy() * (QUANTUM * self._cell_area) * self._cell_counts
        count = len(self._sources)
        return PartVolumes(
            rain=float(volumes[count:].sum()),
            sources=dict(zip(self._source_ids, volumes[:count].tolist(), strict=True)),
        )

    def snapshot(self) -> dict[str, npt.NDArray]:
        """Quanta handed out so far by each source, then by each rain cell, float64."""
        return {"released": self._released.numpy().copy()}

    def restore(self, arrays: Mapping[str, npt.NDArray]) -> None:
        """See `StepPart.restore`."""
        self._released.assign(np.asarray(arrays["released"], np.float64))
