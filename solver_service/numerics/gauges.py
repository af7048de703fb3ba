"""Gauges: time series of single cells, taken between steps and never shortening one."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import warp as wp

from solver_service.errors import ModelError
from solver_service.numerics.fields import Fields, FieldStore
from solver_service.numerics.gauge_kernels import advance_gauge_cursor, record_gauges
from solver_service.numerics.params import SolverParams

DRAIN_STEPS = 256
"""Steps between two calls of `GaugeRecorder.drain` for which there is always room."""

ANY_NUMBER = 1 << 30
"""More steps than anybody takes between two calls."""


@dataclass(frozen=True)
class GaugeSeries:
    """What the gauges saw; arrays are [time, gauge] except `times`."""

    times: npt.NDArray[np.float64]
    """Times [s], multiples of the gauge interval."""
    h: npt.NDArray[np.float32]
    """Depth [m]."""
    eta: npt.NDArray[np.float32]
    """Water surface relative to the case datum [m]; the bed where dry."""
    u: npt.NDArray[np.float32]
    """Velocity to the east [m/s]."""
    v: npt.NDArray[np.float32]
    """Velocity to the north [m/s]."""


class GaugeRecorder:
    """Records the state of the gauge cells at multiples of the interval.

    Args:
        params: gauge places and interval.
        store: rasters of the run.
        dt_max: largest time step [s]; the record buffer has room for the gauge times that so long steps pass.

    Raises:
        ModelError: when a gauge is off the grid.
    """

    def __init__(self, params: SolverParams, store: FieldStore, dt_max: float) -> None:
        self._store = store
        self.interval = params.gauge_interval
        self.count = len(params.gauges)
        self.rows = np.array([round(row) for _, row in params.gauges], np.int32)
        self.cols = np.array([round(col) for col, _ in params.gauges], np.int32)
        for row, col in zip(self.rows.tolist(), self.cols.tolist(), strict=True):
            if not (0 <= row < store.nrows and 0 <= col < store.ncols):
                raise ModelError(f"A gauge stands in cell (row {row}, column {col}), off the grid.")
        self._parts: list[npt.NDArray[np.float32]] = []
        if self.count:
            device = store.device
            self._rows = wp.array(self.rows, dtype=wp.int32, device=device)
            self._cols = wp.array(self.cols, dtype=wp.int32, device=device)
            self._cursor = wp.zeros(2, dtype=wp.int32, device=device)
            room = (DRAIN_STEPS + 8) * (int(dt_max / self.interval) + 2)
            self._records = wp.zeros((room, self.count), dtype=wp.vec4, device=device)

    def begin(self) -> None:
        """Start anew with one record at time zero."""
        if not self.count:
            return
        now = [self._store.read(name)[self.rows, self.cols] for name in ("h", "u", "v")]
        z = self._store.read("z")[self.rows, self.cols]
        self._parts = [np.stack([now[0], z + now[0], now[1], now[2]], axis=-1)[None].astype(np.float32)]
        self._cursor.assign(np.array([1, 1], np.int32))

    def record(self, clock: wp.array, fields: Fields) -> None:
        """Record the gauge times that the step from `h` to `h_out` of `fields` has passed."""
        if not self.count:
            return
        device = self._store.device
        wp.launch(
            record_gauges,
            dim=self.count,
            inputs=[fields, clock, self._rows, self._cols, self.interval, self._cursor],
            outputs=[self._records],
            device=device,
        )
        wp.launch(
            advance_gauge_cursor, dim=1, inputs=[clock, self.interval], outputs=[self._cursor], device=device
        )

    def is_due(self, time: float) -> bool:
        """Whether the next record stands at or before `time` [s]; for devices whose memory the host sees."""
        return self.count > 0 and int(self._cursor.numpy()[0]) * self.interval <= time

    def steps_with_room(self, span: float) -> int:
        """Steps that may be taken before the next `drain` on the way over `span` seconds."""
        if not self.count or span / self.interval + 2.0 <= self._records.shape[0]:
            return ANY_NUMBER
        return DRAIN_STEPS

    def drain(self) -> None:
        """Fetch the new records from the device; see `steps_with_room`."""
        if not self.count:
            return
        following, first = (int(value) for value in self._cursor.numpy())
        if following > first:
            self._parts.append(self._records.numpy()[: following - first].copy())
            self._cursor.assign(np.array([following, following], np.int32))

    def records(self) -> npt.NDArray[np.float32]:
        """All records, h eta u v, [time, gauge, 4]."""
        if not self.count or not self._parts:
            return np.zeros((0, self.count, 4), np.float32)
        self._parts = [np.concatenate(self._parts)]
        return self._parts[0]

    def restore(self, records: npt.NDArray[np.float32]) -> None:
        """Go on after the given records."""
        if self.count:
            self._parts = [np.array(records, np.float32)]
            self._cursor.assign(np.array([len(records)] * 2, np.int32))

    def series(self, first: int = 0) -> GaugeSeries:
        """Everything recorded so far, from a record number on."""
        records = self.records()[first:]
        times = np.arange(first, first + len(records), dtype=np.float64) * self.interval
        return GaugeSeries(times, *(np.ascontiguousarray(records[:, :, k]) for k in range(4)))
