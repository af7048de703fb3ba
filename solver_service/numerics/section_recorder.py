"""Records what passes the sections of a run: totals over every step, and series at the gauge interval."""

from __future__ import annotations

import itertools

import numpy as np
import numpy.typing as npt
import warp as wp

from solver_service.numerics.device import load_structure_kernels
from solver_service.numerics.fields import Fields, FieldStore, FloatRaster, Scheme
from solver_service.numerics.gauges import ANY_NUMBER, DRAIN_STEPS
from solver_service.numerics.params import SolverParams
from solver_service.numerics.section import SectionProfile, SectionSeries, SectionTotals
from solver_service.numerics.section_kernels import (
    PEAK_NONE,
    SectionFaces,
    book_sections,
    measure_sections,
)
from solver_service.numerics.snapping import NORTH_FACE, nearest_on_line
from solver_service.numerics.weirs import Weirs

WALL_KINDS = (wp.float32, wp.float32, wp.int32)
"""What the arrays of walls hold."""

CHUNK = 8
"""Faces that one thread computes."""


class SectionRecorder:
    """Records discharge, volume and wet area of every section.

    Args:
        params: sections and interval.
        store: rasters of the run.
        dx: cell side [m].
        dt_max: largest time step [s]; the record buffer has room for the record times of so long steps.
        weirs: the weirs of the model, whose flow the sections count; None where there are none.

    Raises:
        ModelError: when a section leaves the grid.
    """

    def __init__(
        self, params: SolverParams, store: FieldStore, dx: float, dt_max: float, weirs: Weirs | None
    ) -> None:
        self._store, self._dx = store, dx
        self._sections = params.sections
        self.interval = params.gauge_interval
        self.count = len(params.sections)
        shape = (store.nrows, store.ncols)
        self._chains = [section.chain(shape) for section in params.sections]
        self._parts: list[npt.NDArray[np.float64]] = []
        if not self.count:
            return
        load_structure_kernels(store.device)
        numbers = {} if weirs is None else weirs.numbers
        faces = np.concatenate([chain.faces for chain in self._chains])
        ends = np.cumsum([0, *(len(chain.faces) for chain in self._chains)])
        chunks = [np.arange(a, b, CHUNK) for a, b in itertools.pairwise(ends)]
        self._chunk_count = sum(chunk.size for chunk in chunks)
        self._faces = SectionFaces()
        arrays = {
            "row": faces[:, 0],
            "col": faces[:, 1],
            "is_northern": (faces[:, 2] == NORTH_FACE).astype(np.int32),
            "sign": np.concatenate([chain.sign for chain in self._chains]),
            "wall": np.array(
                [numbers.get((row, col, side), -1) for row, col, side in faces.tolist()], np.int32
            ),
            "share": np.concatenate([chain.share for chain in self._chains]),
            "chunk": np.concatenate([*chunks, ends[-1:]]).astype(np.int32),
            "first_chunk": np.cumsum([0, *(chunk.size for chunk in chunks)]).astype(np.int32),
            "chunk_moved": np.zeros(self._chunk_count),
            "totals": np.zeros((self.count, 3)),
        }
        for name, values in arrays.items():
            values = np.ascontiguousarray(values)
            setattr(
                self._faces,
                name,
                wp.array(values, dtype=wp.dtype_from_numpy(values.dtype), device=store.device),
            )
        if weirs is not None:
            self._walls = weirs.wall_arrays()
        else:
            self._walls = [wp.zeros(1, dtype=kind, device=store.device) for kind in WALL_KINDS]
        self._cursor = wp.zeros((self.count, 2), dtype=wp.int32, device=store.device)
        room = (DRAIN_STEPS + 8) * (int(dt_max / self.interval) + 2)
        self._records = wp.zeros((room, self.count, 3), dtype=wp.float64, device=store.device)

    def begin(self) -> None:
        """Start anew with one record at time zero, whose discharge is that of the water as it stands."""
        if not self.count:
            return
        now = []
        rasters = self._rasters()
        for section in range(self.count):
            profile = self._profile(section, rasters)
            share = self._chains[section].share
            now.append(
                [
                    float((profile.h * profile.speed).sum()) * self._dx,
                    0.0,
                    float((profile.h * share).sum()) * self._dx,
                ]
            )
        self._parts = [np.array(now)[None]]
        self._faces.totals.assign(np.tile([0.0, 0.0, float(PEAK_NONE)], (self.count, 1)))
        self._cursor.fill_(1)

    def record(self, clock: wp.array, fields: Fields, scheme: Scheme) -> None:
        """Count the step of the clock from `h` to `h_out` of `fields`."""
        if not self.count:
            return
        inputs = [fields, scheme, clock]
        device = self._store.device
        measured = [*inputs, *self._walls, self._faces]
        wp.launch(measure_sections, dim=self._chunk_count, inputs=measured, device=device)
        wp.launch(
            book_sections,
            dim=self.count,
            inputs=[*inputs, self.interval, self._faces],
            outputs=[self._cursor, self._records],
            device=device,
        )

    def steps_with_room(self, span: float) -> int:
        """Steps that may be taken before the next `drain` on the way over `span` seconds."""
        if not self.count or span / self.interval + 2.0 <= self._records.shape[0]:
            return ANY_NUMBER
        return DRAIN_STEPS

    def drain(self) -> None:
        """Fetch the new records from the device; see `steps_with_room`."""
        if not self.count:
            return
        following, first = (int(value) for value in self._cursor.numpy()[0])
        if following > first:
            self._parts.append(self._records.numpy()[: following - first].copy())
            self._cursor.fill_(following)

    # --- what there is -------------------------------------------------------------------------------

    def series(self, first: int = 0) -> SectionSeries:
        """Everything recorded so far, from a record number on."""
        records = self.records()[first:]
        times = np.arange(first, first + len(records), dtype=np.float64) * self.interval
        return SectionSeries(times, *(np.ascontiguousarray(records[:, :, k]) for k in range(3)))

    def totals(self) -> tuple[SectionTotals, ...]:
        """What has passed each section since the start."""
        if not self.count:
            return ()
        return tuple(
            SectionTotals(section.id, volume, peak, time if time >= 0.0 else float("nan"))
            for section, (volume, peak, time) in zip(
                self._sections, self._faces.totals.numpy().tolist(), strict=True
            )
        )

    def profile(self, number: int) -> SectionProfile:
        """The water along the section of a number now."""
        return self._profile(number, self._rasters())

    def _rasters(self) -> list[FloatRaster]:
        return [self._store.interior(name) for name in ("h", "u", "v", "z")]

    def _profile(self, number: int, rasters: list[FloatRaster]) -> SectionProfile:
        chain, line = self._chains[number], self._sections[number].line
        row, col, side = chain.faces.T
        north = side == NORTH_FACE
        cells, beyond = (row, col), (row + north, col + ~north)
        place = nearest_on_line(col + 0.5 * ~north, row + 0.5 * north, line)
        near, far = ([raster[at].astype(np.float64) for raster in rasters] for at in (cells, beyond))
        depth = 0.5 * (near[0] + far[0])
        flow = np.where(north, near[2] * near[0] + far[2] * far[0], near[1] * near[0] + far[1] * far[0])
        speed = np.divide(0.5 * chain.sign * flow, depth, out=np.zeros_like(depth), where=depth > 0.0)
        return SectionProfile(place.along * self._dx, np.maximum(near[3], far[3]), depth, speed)

    # --- state ---------------------------------------------------------------------------------------

    def records(self) -> npt.NDArray[np.float64]:
        """All records, [time, section, 3]."""
        if not self.count or not self._parts:
            return np.zeros((0, self.count, 3))
        self._parts = [np.concatenate(self._parts)]
        return self._parts[0]

    def snapshot(self) -> dict[str, npt.NDArray[np.float64]]:
        """Host copies of records and totals; the records' first length is open."""
        totals = self._faces.totals.numpy().copy() if self.count else np.zeros((0, 3))
        return {"section_records": self.records().copy(), "section_totals": totals}

    def restore(self, records: npt.NDArray[np.float64], totals: npt.NDArray[np.float64]) -> None:
        """Go on after the given records and totals."""
        if self.count:
            self._parts = [np.array(records, np.float64)]
            self._faces.totals.assign(np.asarray(totals, np.float64))
            self._cursor.fill_(len(records))
