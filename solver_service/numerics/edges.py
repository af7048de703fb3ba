"""The edges of a run on its device: what they ask for, the ghost cells, and what has passed them.

A segment that may bring water keeps the tiles at it awake; at every other edge nothing happens while the
water inside sleeps. See `edge_states` for the water at an edge and `edge_kernels` for the books.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
import numpy.typing as npt
import warp as wp

from solver_service.numerics.edge_boundary import EDGE_KINDS, EDGES, EdgeBoundary, edge_cells
from solver_service.numerics.edge_kernels import (
    RATING_LENGTH,
    EdgeSegments,
    book_edge_flow,
    decide_edge_values,
    weigh_edge_cells,
)
from solver_service.numerics.fields import Fields, FieldStore, FloatRaster
from solver_service.numerics.friction import GRAVITY
from solver_service.numerics.ghost_kernels import fill_ghost_cells, pad_bed
from solver_service.numerics.model import FloodModel
from solver_service.numerics.params import SolverParams
from solver_service.numerics.step_part import PartVolumes

SLOPE_CONTINUED = 0.1
"""Steepest bed at an edge that goes on behind it [1]; steeper is a step of the raster."""

CHUNK = 32
"""Faces that one thread books."""

SEGMENT_KEPT = ("unmet",)
FACE_KEPT = ("rest_h", "rest_u", "came")
"""Arrays of `EdgeSegments` that a snapshot holds, under names that begin with `edge_`."""


def segment_names(boundaries: tuple[EdgeBoundary, ...]) -> tuple[str, ...]:
    """Name of every boundary that is no wall: its id, else west-1, west-2, ... by its place at its edge."""
    names: list[str] = []
    counts = dict.fromkeys(EDGES, 0)
    for boundary in boundaries:
        if boundary.kind != "wall":
            counts[boundary.edge] += 1
            names.append(boundary.id or f"{boundary.edge}-{counts[boundary.edge]}")
    return tuple(names)


def critical_rating(
    bed: FloatRaster, dx: float, discharge_max: float
) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.float32]]:
    """Levels [m] up to that of `discharge_max` [m3/s], and the critical discharge over a bed at each.

    Args:
        bed: bed of the cells of a segment [m].
        dx: cell side [m].
        discharge_max: largest discharge wanted [m3/s].
    """
    z = np.sort(bed.astype(np.float64))

    def discharge(level: float) -> float:
        return float((np.maximum(level - z, 0.0) ** 1.5).sum()) * dx * math.sqrt(GRAVITY)

    low, high = 0.0, 0.01
    while discharge(z[0] + high) < discharge_max:
        low, high = high, 2.0 * high
    for _ in range(40):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if discharge(z[0] + middle) < discharge_max else (low, middle)
    levels = z[0] + high * np.linspace(0.0, 1.0, RATING_LENGTH) ** 1.5
    return levels.astype(np.float32), np.array([discharge(level) for level in levels], np.float32)


class Edges:
    """Everything at the edges of a model; a `StepPart` of models whose edges are not all walls.

    Args:
        model: what does not move.
        params: scheme and tuning.
        store: rasters of the run.
    """

    dt_max = math.inf
    names = tuple(f"edge_{name}" for name in (*SEGMENT_KEPT, *FACE_KEPT))

    def __init__(self, model: FloodModel, params: SolverParams, store: FieldStore) -> None:
        self._store, self._model, self._depth_dry = store, model, params.depth_dry
        self._device = store.device
        self._boundaries = tuple(b for b in model.boundaries if b.kind != "wall")
        self._ids = segment_names(model.boundaries)
        self.count = len(self._boundaries)
        self.segment = np.full((4, max(model.shape)), -1, np.int32)
        for k, b in enumerate(self._boundaries):
            self.segment[EDGES.index(b.edge), b.first : b.last] = k
        self._has_discharge = any(b.kind == "discharge" for b in self._boundaries)
        self._has_series = any(b.may_bring_water for b in self._boundaries)
        self._arrays: dict[str, wp.array] = {}
        self._segments = self._build()
        self.set_bed(model.z_b)

    # --- arrays ------------------------------------------------------------------------------------

    def _build(self) -> EdgeSegments:
        chunks = [
            [EDGES.index(b.edge), first, min(first + CHUNK, b.last), k]
            for k, b in enumerate(self._boundaries)
            for first in range(b.first, b.last, CHUNK)
        ] + [[edge, face, face + 1, self.count] for edge, face in self._walls_beside()]
        self._axes = sorted({chunk[0] // 2 for chunk in chunks})
        series = [self._series(b) for b in self._boundaries]
        owners = np.array([chunk[3] for chunk in chunks], np.int32)
        faces, count, room = self.segment.shape, max(1, self.count), max(1, len(chunks))
        self.chunk_count = len(chunks)
        values = {
            "segment": self.segment,
            "kind": np.array([EDGE_KINDS.index(b.kind) for b in self._boundaries], np.int32),
            "slope": np.array([b.slope or 0.0 for b in self._boundaries], np.float32),
            "series": np.cumsum([0, *(times.size for times, _, _ in series)]).astype(np.int32),
            "times": np.concatenate([np.zeros(0), *(times for times, _, _ in series)]),
            "values": np.concatenate([np.zeros(0), *(values for _, values, _ in series)]),
            "volumes": np.concatenate([np.zeros(0), *(volumes for _, _, volumes in series)]),
            "rating_level": np.zeros((count, RATING_LENGTH), np.float32),
            "rating_discharge": np.zeros((count, RATING_LENGTH), np.float32),
            "chunk": np.array(chunks, np.int32).reshape(-1, 4),
            "first_chunk": np.searchsorted(owners, np.arange(self.count + 1)).astype(np.int32),
            "rest_h": np.zeros(faces, np.float32),
            "rest_u": np.zeros(faces, np.float32),
            "level": np.zeros(count),
            "due": np.zeros(count),
            "unmet": np.zeros(count),
            "weight": np.zeros(faces, np.float32),
            "chunk_weight": np.zeros(room),
            "chunk_flow": np.zeros(room),
            "flow_seen": np.zeros(faces),
            "came": np.zeros(faces),
        }
        segments = EdgeSegments()
        for name, array in values.items():
            array = array if array.size else np.zeros((1, *array.shape[1:]), array.dtype)
            dtype = wp.dtype_from_numpy(array.dtype)
            self._arrays[name] = wp.array(array, dtype=dtype, device=self._device)
            setattr(segments, name, self._arrays[name])
        return segments

    def pad_bed(self, z_b: FloatRaster) -> FloatRaster:
        """Bed [m] with ghost cells."""
        fall_max = np.full(self.segment.shape, SLOPE_CONTINUED * self._model.dx, np.float32)
        rise_max = np.zeros_like(fall_max)
        for b in self._boundaries:
            if b.kind == "discharge":
                faces = (EDGES.index(b.edge), slice(b.first, b.last))
                rise_max[faces] = fall_max[faces]
        return pad_bed(z_b, self.segment, fall_max, rise_max)

    def _walls_beside(self) -> list[tuple[int, int]]:
        """Edge and face of the walls next to a segment along the edge or round a corner."""
        nrows, ncols = self._model.shape
        lengths = (nrows, nrows, ncols, ncols)
        beside = set()
        for b in self._boundaries:
            edge = EDGES.index(b.edge)
            corner = 0 if edge in (0, 2) else lengths[3 - edge] - 1
            beside.add((edge, b.first - 1) if b.first else (2 - edge // 2 * 2, corner))
            beside.add((edge, b.last) if b.last < lengths[edge] else (3 - edge // 2 * 2, corner))
        return sorted((edge, face) for edge, face in beside if self.segment[edge, face] < 0)

    @staticmethod
    def _series(
        boundary: EdgeBoundary,
    ) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64], npt.NDArray[np.float64]]:
        """Times, values and the integral of the values from time 0."""
        times, values = boundary.times, boundary.values
        if times is None or values is None:
            return np.zeros(0), np.zeros(0), np.zeros(0)
        volumes = np.concatenate([[0.0], np.cumsum(0.5 * (values[1:] + values[:-1]) * np.diff(times))])
        # Time 0 becomes an entry in thought: what a trapezoid rule over the entries before it gives.
        before = times[times < 0.0]
        entries = np.concatenate([before, [0.0]])
        zero = float(np.trapezoid(np.interp(entries, times, values), entries))
        if times[0] > 0.0:
            zero = -float(times[0] * values[0])
        return times, values, volumes - zero

    def set_bed(self, z_b: FloatRaster) -> None:
        """Take over a bed [m], [nrows, ncols], for the critical flow of the discharges."""
        if not self._has_series:
            return
        levels, discharges = (np.array(self._arrays[f"rating_{n}"].numpy()) for n in ("level", "discharge"))
        for k, b in enumerate(self._boundaries):
            bed = edge_cells(z_b, b.edge)[b.first : b.last]
            if self._model.blocked is not None:
                bed = bed[~edge_cells(self._model.blocked, b.edge)[b.first : b.last]]
            if b.kind == "discharge" and b.values is not None:
                levels[k], discharges[k] = critical_rating(bed, self._model.dx, max(0.0, b.values.max()))
            elif bed.size:
                levels[k] = bed.min()
        self._arrays["rating_level"].assign(levels)
        self._arrays["rating_discharge"].assign(discharges)

    def change_rest(self, before: FloatRaster, after: FloatRaster) -> None:
        """Let a change of the bed [m] change the water at the start like any water (see `bed_change`)."""
        rest_h = self._arrays["rest_h"].numpy().copy()
        for number, edge in enumerate(EDGES):
            rise = edge_cells(after, edge) - edge_cells(before, edge)
            cells = rest_h[number, : rise.size]
            cells[:] = np.where(rise > 0.0, np.maximum(cells - rise, 0.0), cells)
        self._arrays["rest_h"].assign(rest_h)

    # --- before the step ---------------------------------------------------------------------------

    def wave_speed(self, time: float, dt: float) -> float:
        """Largest wave speed that a first step of `dt` from `time` [s] may meet at the edges [m/s]."""
        fastest = 0.0
        levels, discharges = (self._arrays[f"rating_{n}"].numpy() for n in ("level", "discharge"))
        for k, b in enumerate(self._boundaries):
            if b.times is not None and b.values is not None:
                soon = np.interp([time, time + dt], b.times, b.values).max()
                level = soon if b.kind == "stage" else np.interp(soon, discharges[k], levels[k])
                depth = max(0.0, float(level - levels[k, 0]))
                fastest = max(fastest, 2.0 * math.sqrt(GRAVITY * depth))
        return float(np.float32(fastest))  # in the precision in which every engine keeps it

    def fill(
        self, clock: wp.array, fields: Fields, ghosts: wp.array, waves: wp.array, record: bool = False
    ) -> list[wp.Launch]:
        """Fill ghost cells of `h`, `u`, `v` of `fields` for the step of the clock, or record the launches.

        Args:
            clock: see `clock_kernels`.
            fields: rasters; `h`, `u`, `v` hold the state before the step.
            ghosts: flat padded numbers of the ghost cells to fill.
            waves: gets the largest wave speeds at edges that bring water [m/s].
            record: record the launches instead; the ghost cells' is the last.
        """
        store, segments = self._store, self._segments
        size = [store.nrows, store.ncols]
        launches: list[tuple[wp.Kernel, int, list[object], list[wp.array]]] = []
        if self._has_series:
            cell_area = self._model.dx * self._model.dx
            launches.append((decide_edge_values, self.count, [clock, cell_area, segments], [waves]))
        if self._has_discharge:
            inputs = [fields.h, fields.z, fields.drag, self._depth_dry, *size, segments]
            launches.append((weigh_edge_cells, self.chunk_count, inputs, []))
        inputs = [clock, ghosts, fields.z, self._model.dx, *size, segments]
        outputs = [fields.drag, fields.h, fields.u, fields.v, waves]
        launches.append((fill_ghost_cells, ghosts.shape[0], inputs, outputs))
        recorded = [
            wp.launch(kernel, dim, inputs, outputs, device=self._device, record_cmd=record)
            for kernel, dim, inputs, outputs in launches
        ]
        return [launch for launch in recorded if launch is not None]

    # --- after the step: see `StepPart` --------------------------------------------------------------

    def cells(self) -> npt.NDArray[np.bool_]:
        """See `StepPart`: cells at segments that may bring water."""
        mask = np.zeros(self._model.shape, np.bool_)
        for b in self._boundaries:
            if b.may_bring_water:
                edge_cells(mask, b.edge)[b.first : b.last] = True
        return mask

    def begin(self) -> None:
        """See `StepPart`; the water that stands at the edges now is what open edges lead to."""
        for name in ("unmet", "came", "flow_seen", "chunk_flow", "due"):
            self._arrays[name].zero_()
        if not any(b.kind == "open" for b in self._boundaries):
            return
        h, u, v = (self._store.interior(name) for name in ("h", "u", "v"))
        rest_h, rest_u = np.zeros(self.segment.shape, np.float32), np.zeros(self.segment.shape, np.float32)
        for number, (edge, outward) in enumerate(zip(EDGES, (-u, u, -v, v), strict=True)):
            cells = edge_cells(h, edge)
            rest_h[number, : cells.size] = cells
            rest_u[number, : cells.size] = np.maximum(edge_cells(outward, edge), 0.0)
        self._arrays["rest_h"].assign(rest_h)
        self._arrays["rest_u"].assign(rest_u)

    def apply(self, clock: wp.array, fields: Fields) -> None:
        """See `StepPart`: book what has passed."""
        for axis in self._axes:
            wp.launch(
                book_edge_flow,
                dim=self.chunk_count,
                inputs=[fields, axis, self._store.nrows, self._store.ncols, self._segments],
                device=self._device,
            )

    def volumes(self) -> PartVolumes:
        """See `StepPart`."""
        area = self._model.dx * self._model.dx
        came, flow = self._arrays["came"].numpy(), self._store.edge_flow.numpy()
        edges = {}
        for k, name in enumerate(self._ids):
            mine = self.segment == k
            entered = float(came[mine].sum())
            edges[name] = (entered * area, (entered + float(flow[mine].sum())) * area)
        return PartVolumes(edges=edges)

    def unmet(self) -> dict[str, float]:
        """Volume that each discharge was to take out and that was not there [m3]."""
        unmet = -self._arrays["unmet"].numpy()
        return {
            name: float(unmet[k])
            for k, (name, b) in enumerate(zip(self._ids, self._boundaries, strict=True))
            if b.kind == "discharge"
        }

    def snapshot(self) -> dict[str, npt.NDArray]:
        """See `StepPart`."""
        return {f"edge_{name}": self._arrays[name].numpy().copy() for name in (*SEGMENT_KEPT, *FACE_KEPT)}

    def restore(self, arrays: Mapping[str, npt.NDArray]) -> None:
        """See `StepPart`; the edge flows of the store are those of the snapshot already."""
        for name in (*SEGMENT_KEPT, *FACE_KEPT):
            self._arrays[name].assign(arrays[f"edge_{name}"])
        flow = self._store.edge_flow.numpy()
        self._arrays["flow_seen"].assign(flow)
        chunks = self._arrays["chunk"].numpy()
        sums = np.zeros(max(1, self.chunk_count))
        for c, (edge, first, last, _) in enumerate(chunks[: self.chunk_count].tolist()):
            total = 0.0
            for depth in flow[edge, first:last].tolist():  # in the order of the device
                total += depth
            sums[c] = total
        self._arrays["chunk_flow"].assign(sums)
