"""One case on one device with the solver that computes it: states in and out, beds from edits."""

from __future__ import annotations

import dataclasses
import hashlib
import time as clock
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from protocol import CHANNEL_FIELDS, ChannelName, GridInfo, apply_edits
from solver_service.numerics import (
    MemoryOptions,
    ShallowWaterSolver,
    Snapshot,
    allocation_table,
    device_bytes,
)
from solver_service.runs.case_facts import CaseFacts
from solver_service.runs.edit_blobs import unpack_edits
from solver_service.runs.ground_layers import layers_of
from solver_service.runs.lineage import Leg
from solver_service.runs.placement import LocalPlacement, Placement
from solver_service.scenario import Case, load_case
from solver_service.scenario.forced_model import ForcedFrom, forced_model, stretches
from solver_service.scenario.forcing_items import forcing_items
from solver_service.scenario.told_places import gauge_places, section_places
from solver_service.store import StoredState

Course = tuple[ForcedFrom, ...]


class Computation:
    """A loaded case and its solver."""

    def __init__(
        self, name: str, device: str, threads: int | None, placement: Placement | None = None
    ) -> None:
        """Load the case and put its first state on the device.

        Args:
            name: name or path of the case.
            device: "auto", "cpu" or "cuda:N".
            threads: solver threads on the CPU; None for all cores.
            placement: chooses the device; None for those of this machine.

        Raises:
            ServiceError: the case or the device cannot be used.
        """
        self.name = name
        self.case: Case = load_case(name)
        self.fingerprint = fingerprint(self.case)
        self._params = dataclasses.replace(self.case.params, threads=threads or self.case.params.threads)
        self.device = (placement or LocalPlacement()).place(device, self._needed)
        self._make_solver(())
        self._wall_s = 0.0
        self._advancing_since: float | None = None

    def _needed(self, device: str) -> int:
        options = MemoryOptions.of(self.case.model, self._params, self._params.threads or 1)
        return device_bytes(allocation_table(self.case.grid.shape, options, device), device)

    @property
    def facts(self) -> CaseFacts:
        """What the run tree keeps of the case."""
        return CaseFacts(
            grid=GridInfo.from_geometry(self.case.grid),
            hypothetical=self.case.hypothetical,
            depth_wet=self.depth_wet,
            source=self.case.source,
            licence=self.case.licence,
            start_time=self.case.start_time,
            forcing=forcing_items(self.case),
            layers=layers_of(self.case),
            gauges=gauge_places(self.case),
            sections=section_places(self.case),
        )

    @property
    def depth_wet(self) -> float:
        """Depth from which a cell counts as wet [m]."""
        return self.case.params.depth_dry

    def state(self) -> StoredState:
        """The exact state at this moment."""
        snapshot = self.solver.snapshot()
        return StoredState(self.solver.time, self.solver.step_count, snapshot.arrays, snapshot.scalars)

    def restore(self, state: StoredState | None, course: Course = ()) -> None:
        """Go to a state; None is the state at time 0.

        Args:
            state: the state.
            course: from when on which changes of the forcing hold in the run that it belongs to.
        """
        driven = stretches(course)
        if driven != self._driven:
            self._make_solver(driven)
        state = state or self._initial
        self.solver.restore(Snapshot(dict(state.arrays), dict(state.scalars)))

    def enter(self, leg: Leg, course: Course = ()) -> tuple[str, ...]:
        """Lay the bed of a leg under the water of this moment, and let its forcing take over.

        Args:
            leg: the leg.
            course: from when on which changes of the forcing hold, this leg's last.

        Returns:
            Sentences about breaches that had begun before and cannot be moved.
        """
        told: tuple[str, ...] = ()
        driven = stretches(course)
        if driven != self._driven:
            told = self._change_forcing(driven)
        edits = unpack_edits(leg.edits)
        self.solver.replace_bed(apply_edits(self.case.z_b, edits, self.case.grid).z_b)
        return told

    def _change_forcing(self, driven: Course) -> tuple[str, ...]:
        snapshot, states = self.solver.snapshot(), self.solver.breach_states()
        before = self.solver.model.breaches
        self._make_solver(driven)
        self.solver.adopt(snapshot)
        return tuple(
            f"the breach {state.id!r} had begun at {state.started_at:g} s and keeps its course;"
            " its start cannot be moved any more"
            for state, held, wanted in zip(states, before, self.solver.model.breaches, strict=True)
            if state.started_at is not None and held != wanted
        )

    def _make_solver(self, driven: Course) -> None:
        """A solver under a course of changes, with the water of time 0."""
        self._driven = driven
        self.solver = ShallowWaterSolver(forced_model(self.case, driven), self._params, self.device)
        self.solver.set_water(self.case.initial_h)
        self._initial = self.state()

    def advance_to(self, time: float, should_stop: Callable[[], bool]) -> bool:
        """Compute up to a time [s]; False when stopped before."""
        self._advancing_since = begun = clock.perf_counter()
        try:
            return self.solver.advance_to(time, should_stop)
        finally:
            self._wall_s += clock.perf_counter() - begun
            self._advancing_since = None

    @property
    def elapsed_s(self) -> float:
        """Wall time spent in time steps [s], the call under way included."""
        since = self._advancing_since
        return self._wall_s + (clock.perf_counter() - since if since is not None else 0.0)

    def depth_max(self) -> float:
        """Greatest depth of this moment [m]."""
        return float(self.solver.depth().max(initial=0.0))

    def channel(self, name: ChannelName) -> dict[str, NDArray[np.float32]]:
        """The fields of a channel at this moment, as the solver has them."""
        read = self.solver.velocity_fields if name == "velocity" else self.solver.maximum_fields
        return dict(zip(CHANNEL_FIELDS[name], read(), strict=True))

    def quantise(self, scale: float) -> tuple[NDArray[np.uint16], NDArray[np.uint8]]:
        """Quantised depth and block states of this moment, as arrays of their own."""
        return self.solver.quantise(scale, self.depth_wet)


def fingerprint(case: Case) -> str:
    """Hash of everything of a case that a resumed run depends on."""
    digest = hashlib.sha256()
    for part in (case.z_b, case.initial_h, case.grid, case.params):
        _feed(digest, part)
    for part in dataclasses.astuple(case.model):
        _feed(digest, part)
    return digest.hexdigest()[:32]


def _feed(digest: hashlib._Hash, value: object) -> None:
    if isinstance(value, np.ndarray):
        digest.update(f"{value.dtype.str}{value.shape}".encode())
        digest.update(np.ascontiguousarray(value).reshape(-1).view(np.uint8).data)
    elif isinstance(value, dict):
        _feed(digest, sorted(value.items()))
    elif isinstance(value, list | tuple):
        for item in value:
            _feed(digest, item)
    else:
        digest.update(repr(value).encode())
