"""The solver: a model, the water on it, and time."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from solver_service.errors import ModelError
from solver_service.numerics.active_tiles import ActiveTiles
from solver_service.numerics.after_step import changeable_cells, parts_of
from solver_service.numerics.bed_change import BedChange, change_water, check_bed
from solver_service.numerics.blow_up import explain_blow_up
from solver_service.numerics.breach import BreachState
from solver_service.numerics.breaches import Breaches
from solver_service.numerics.budget import VolumeBudget, close_budget, stored_volume
from solver_service.numerics.conduits import Conduits, ConduitState
from solver_service.numerics.device import pick_device, thread_count, warm_kernels
from solver_service.numerics.edges import Edges
from solver_service.numerics.engine import Engine, StepCollapse, StepParts, StopQuestion
from solver_service.numerics.fastest_cell import fastest_cell
from solver_service.numerics.fields import TILE, FieldStore, FloatRaster, Scheme
from solver_service.numerics.friction import GRAVITY
from solver_service.numerics.gauges import GaugeRecorder, GaugeSeries
from solver_service.numerics.infiltration import GroundUptake
from solver_service.numerics.kernel_engine import KernelEngine
from solver_service.numerics.maxima import Maxima, begin_maxima, end_wet_spells, read_maxima
from solver_service.numerics.model import FloodModel
from solver_service.numerics.params import SolverParams
from solver_service.numerics.read_out import read_maximum_fields, read_quantised, read_velocity
from solver_service.numerics.row_engine import RowEngine, rows_compile
from solver_service.numerics.section import SectionProfile, SectionSeries, SectionTotals
from solver_service.numerics.section_recorder import SectionRecorder
from solver_service.numerics.snapshot import Snapshot
from solver_service.numerics.state_keeping import check_snapshot, put_back, take_snapshot, with_new_rain
from solver_service.numerics.weirs import Weirs

WALL_HEIGHT = 1000.0
"""How far blocked cells stand above the highest bed [m]."""

WAVE_FLOOR = 1.0
"""Wave speed that a step always allows for [m/s], so that the first water does not meet a giant step."""


class ShallowWaterSolver:
    """Computes the flood of a model.

    One thread owns a solver. Rasters that come in or go out are host arrays [row, col], row 0 in the south.

    Args:
        model: what does not move.
        params: scheme and tuning.
        device: `cpu`, `cuda:N` or `auto`.

    Raises:
        DeviceError: when the device is not there.
        ModelError: when a gauge is off the grid.
    """

    def __init__(self, model: FloodModel, params: SolverParams | None = None, device: str = "cpu") -> None:
        self.model = model
        self.params = params = params or SolverParams()
        self.device = pick_device(device)
        self._store = store = FieldStore(*model.shape, self.device, params.arrival_depths)
        self._edges = Edges(model, params, store)
        self._set_bed(model.z_b)
        drag = float(GRAVITY) * np.broadcast_to(np.asarray(model.manning_n, np.float64), model.shape) ** 2
        store.write_padded("drag", np.pad(drag.astype(np.float32), 2, mode="symmetric"))
        self._tiles = ActiveTiles(store, params.depth_film, model.infiltration is not None)
        scheme = self._scheme()
        self._after_step = parts_of(model, params, store, self._tiles, scheme, self._edges)
        self._weirs = next((part for part in self._after_step if isinstance(part, Weirs)), None)
        self._breaches = next((part for part in self._after_step if isinstance(part, Breaches)), None)
        self._conduits = next((part for part in self._after_step if isinstance(part, Conduits)), None)
        self._tiles.keep_awake(changeable_cells(self._after_step, model.shape))
        longest = [params.dt_max, params.cfl * model.dx / WAVE_FLOOR]
        self._dt_max = min([*longest, *(part.dt_max for part in self._after_step)])
        self._gauges = GaugeRecorder(params, store, self._dt_max)
        self._sections = SectionRecorder(params, store, model.dx, self._dt_max, self._weirs)
        self._engine = self._choose_engine(scheme)
        self._initial_volume = 0.0
        self._edits_volume = 0.0
        self.set_water(np.zeros(model.shape, np.float32))

    def _set_bed(self, z_b: FloatRaster) -> None:
        self._z_b = z_b.copy()
        self._store.write_padded("z", self._walled(z_b))
        self._edges.set_bed(z_b)

    def _walled(self, z_b: FloatRaster) -> FloatRaster:
        if self.model.blocked is not None:
            z_b = np.where(self.model.blocked, z_b.max() + np.float32(WALL_HEIGHT), z_b)
        return self._edges.pad_bed(z_b)

    def _scheme(self) -> Scheme:
        params, scheme = self.params, Scheme()
        scheme.dx = self.model.dx
        scheme.theta = params.limiter_theta if params.order == 2 else 0.0
        scheme.hancock = 1.0 if params.order == 2 else 0.0
        scheme.contact = 1.0 if params.riemann == "hllc" else 0.0
        scheme.depth_dry = params.depth_dry
        scheme.depth_film = params.depth_film
        scheme.depth_cfl = params.depth_cfl
        scheme.eddy = params.eddy_viscosity
        scheme.courant = params.cfl * self.model.dx
        scheme.depth_arrival = params.depth_arrival
        scheme.nrows, scheme.ncols = self.model.shape
        return scheme

    def _choose_engine(self, scheme: Scheme) -> Engine:
        params = self.params
        parts = StepParts(
            store=self._store,
            scheme=scheme,
            tiles=self._tiles,
            after_step=self._after_step,
            gauges=self._gauges,
            sections=self._sections,
            edges=self._edges,
            courant=params.cfl * self.model.dx,
            dt_max=self._dt_max,
            dt_min=params.dt_min,
        )
        if self.device == "cpu" and params.engine in ("auto", "rows") and rows_compile():
            return RowEngine(parts, thread_count(params.threads))
        warm_kernels(self.device, with_oracle=True)
        by_tiles = params.engine == "tiles" or (self.device != "cpu" and params.engine == "auto")
        return KernelEngine(parts, by_tiles)

    # --- water ---------------------------------------------------------------------------------

    def set_water(
        self, h: npt.ArrayLike, u: npt.ArrayLike | None = None, v: npt.ArrayLike | None = None
    ) -> None:
        """Begin at time zero with the given water; maxima, budget and gauges begin anew.

        Args:
            h: depth [m], [nrows, ncols], finite and not negative.
            u: velocity to the east [m/s]; None is water at rest.
            v: velocity to the north [m/s].

        Raises:
            ModelError: naming the cell that is not valid.
        """
        depth = self._checked("depth", h)
        if self.model.blocked is not None:
            depth = np.where(self.model.blocked, np.float32(0.0), depth)
        negative = np.argwhere(depth < 0.0)
        if negative.size:
            row, col = negative[0]
            raise ModelError(
                f"The depth is {depth[row, col]} m in cell (row {row}, column {col}); >= 0 is allowed."
            )
        moving = depth > self.params.depth_dry
        store, engine = self._store, self._engine
        store.write("h", depth)
        for name, values in (("u", u), ("v", v)):
            velocity = np.zeros_like(depth) if values is None else self._checked(f"velocity {name}", values)
            store.write(name, np.where(moving, velocity, np.float32(0.0)))
        engine.time, engine.dt, engine.step_count = 0.0, 0.0, 0
        begin_maxima(store, depth, self.params.depth_arrival)
        store.edge_flow.zero_()
        for part in self._after_step:
            part.begin()
        self._initial_volume = stored_volume(store, self.model.dx)
        self._edits_volume = 0.0
        self._gauges.begin()
        self._sections.begin()
        self._water_changed()

    def _checked(self, what: str, values: npt.ArrayLike) -> FloatRaster:
        array = np.ascontiguousarray(values, np.float32)
        if array.shape != self.model.shape:
            raise ModelError(f"The {what} has the shape {array.shape}; the grid's is {self.model.shape}.")
        bad = np.argwhere(~np.isfinite(array))
        if bad.size:
            row, col = bad[0]
            raise ModelError(
                f"The {what} is {array[row, col]} in cell (row {row}, column {col}); finite is allowed."
            )
        return array

    def _water_changed(self) -> None:
        at_edges = self._edges.wave_speed(self.time, self._dt_max)
        self._engine.wave_speed = max(fastest_cell(self._store).wave, at_edges)

    # --- time ------------------------------------------------------------------------------------

    @property
    def time(self) -> float:
        """Simulation time [s]."""
        return self._engine.time

    @property
    def step_count(self) -> int:
        """Steps since the start."""
        return self._engine.step_count

    @property
    def dt(self) -> float:
        """Time step that stability allows now [s]."""
        wave = fastest_cell(self._store).wave
        return min(self._engine.parts.courant / wave, self._dt_max) if wave > 0.0 else self._dt_max

    def advance_to(self, time: float, should_stop: StopQuestion | None = None) -> bool:
        """Compute up to exactly `time` [s].

        Args:
            time: where to land [s]; not before the present time.
            should_stop: asked between steps, now and then; True ends early with a valid state.

        Returns:
            True when the time is reached, False after an early end.

        Raises:
            ModelError: when the time lies in the past or is not finite.
            SolverBlowUp: when a value is not finite or the time step collapsed.
        """
        if not (math.isfinite(time) and time >= self.time):
            raise ModelError(
                f"The time to compute to is {time} s; at least the present {self.time} s is allowed."
            )
        try:
            return self._engine.advance(float(time), should_stop)
        except StepCollapse:
            courant, dt_min = self._engine.parts.courant, self.params.dt_min
            raise explain_blow_up(self.model, self._store, self.time, dt_min, courant) from None

    def limiting_cell(self) -> tuple[int, int]:
        """Row and column of the cell that decides the time step."""
        fastest = fastest_cell(self._store)
        return fastest.row, fastest.col

    # --- what there is -----------------------------------------------------------------------------

    @property
    def bed(self) -> FloatRaster:
        """Bed as it is now [m], a copy."""
        z_b, blocked = self._store.read("z"), self.model.blocked
        return z_b if blocked is None else np.where(blocked, self._z_b, z_b)

    def depth(self) -> FloatRaster:
        """Depth [m], a host copy [nrows, ncols]."""
        return self._store.read("h")

    def velocity(self) -> tuple[FloatRaster, FloatRaster]:
        """Velocities to the east and to the north [m/s], host copies."""
        return self._store.read("u"), self._store.read("v")

    @property
    def wet_cells(self) -> int:
        """Cells deeper than `depth_dry`."""
        return int(np.count_nonzero(self._store.interior("h") > self.params.depth_dry))

    @property
    def active_cells(self) -> int:
        """Cells of the tiles that the last step computed."""
        return int(np.count_nonzero(self._tiles.mask())) * TILE * TILE

    def maxima(self) -> Maxima:
        """Largest values since the start, host copies."""
        return read_maxima(self._store, self.time, self.params.depth_dry)

    def budget(self) -> VolumeBudget:
        """Where the water came from and went."""
        dx = self.model.dx
        return close_budget(
            self._initial_volume,
            stored_volume(self._store, dx),
            self._edits_volume,
            (part.volumes() for part in self._after_step),
        )

    def infiltrated(self) -> FloatRaster | None:
        """Depth that the ground has taken since the start [m], a host copy; None without infiltration."""
        uptake = next((part for part in self._after_step if isinstance(part, GroundUptake)), None)
        return None if uptake is None else uptake.depth

    def breached_bed(self) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.float32]]:
        """Cells that breaches have lowered so far, as row x ncols + col, rising, and their bed now [m]."""
        if self._breaches is None:
            return np.zeros(0, np.int64), np.zeros(0, np.float32)
        return self._breaches.lowered()

    def breach_states(self) -> tuple[BreachState, ...]:
        """How far each breach of the model has grown."""
        return self._breaches.states() if self._breaches is not None else ()

    def conduit_states(self) -> tuple[ConduitState, ...]:
        """What each culvert and pump of the model does."""
        return self._conduits.states() if self._conduits is not None else ()

    def gauge_series(self, first: int = 0) -> GaugeSeries:
        """What the gauges of the parameters have recorded, from a record number on."""
        return self._gauges.series(first)

    def unmet_outflow(self) -> dict[str, float]:
        """Volume that each discharge edge was to take out and that was not there [m3]."""
        return self._edges.unmet()

    def section_series(self, first: int = 0) -> SectionSeries:
        """What has passed the sections of the parameters, at the gauge interval; from a record number on."""
        return self._sections.series(first)

    def section_totals(self) -> tuple[SectionTotals, ...]:
        """Volume and peak discharge of each section, from every step."""
        return self._sections.totals()

    def section_profile(self, number: int) -> SectionProfile:
        """The water along the section of a number, counted from 0, now."""
        return self._sections.profile(number)

    def quantise(
        self, scale: float, depth_wet: float
    ) -> tuple[npt.NDArray[np.uint16], npt.NDArray[np.uint8]]:
        """Fixed-point depth and block states, made on the device; see `wet_block_kernels`.

        Args:
            scale: depth of one unit [m].
            depth_wet: depth below which a cell is dry [m].

        Returns:
            q [nrows, ncols] and states [block_rows, block_cols].
        """
        return read_quantised(self._store, scale, depth_wet)

    def velocity_fields(self) -> npt.NDArray[np.float32]:
        """Velocity to the east and north [m/s], host copy [2, nrows, ncols]."""
        return read_velocity(self._store)

    def maximum_fields(self) -> npt.NDArray[np.float32]:
        """Largest depth [m], speed [m/s], hazard, first arrival [s], host copy [4, nrows, ncols].

        The arrival is `fields.NEVER` where it has not come.
        """
        return read_maximum_fields(self._store)

    # --- change and keep ---------------------------------------------------------------------------

    def replace_bed(self, z_b: npt.ArrayLike) -> BedChange:
        """Set the bed [m], effective at once; see `bed_change` for the water on it.

        The same bed again changes nothing: what follows is bit for bit what would have followed.

        Raises:
            ModelError: when shape or values are not valid.
        """
        bed = check_bed(z_b, self.model.shape)
        before = self.bed
        self._set_bed(bed)
        if self._breaches is not None:
            self._breaches.take_ground()
        after = self.bed
        if np.array_equal(before, after):
            return BedChange(volume_cut=0.0, changed_cells=0)
        self._edges.change_rest(before, after)
        change = change_water(self._store, before, after, self.params.depth_dry, self.model.dx)
        self._edits_volume += change.volume_cut
        end_wet_spells(self._store, self.time, self.params.depth_arrival)
        if self._weirs is not None:
            self._weirs.remember()
        self._water_changed()
        return change

    def snapshot(self) -> Snapshot:
        """The exact state; see `Snapshot`."""
        volumes = {"initial_volume": self._initial_volume, "edits_volume": self._edits_volume}
        return take_snapshot(self._engine, self.bed, volumes)

    def restore(self, snapshot: Snapshot) -> None:
        """Go back to a state of this model; what follows is bit for bit what followed then.

        Raises:
            ModelError: when the snapshot lacks a part or belongs to another model.
        """
        check_snapshot(self._engine, snapshot)
        self._set_bed(np.array(snapshot.arrays["z_b"], np.float32))
        put_back(self._engine, snapshot)
        self._initial_volume = float(snapshot.scalars["initial_volume"])
        self._edits_volume = float(snapshot.scalars["edits_volume"])

    def adopt(self, snapshot: Snapshot) -> None:
        """Go on from a state of a model whose forcing differs from then on; rain may be new.

        Raises:
            ModelError: when the snapshot belongs to another model.
        """
        self.restore(with_new_rain(self._engine, snapshot))
        self._water_changed()
