"""One case on one device with the solver that computes it: states in and out, beds from edits."""

from __future__ import annotations

import dataclasses
import hashlib
import time as clock
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from protocol import GridInfo, apply_edits
from solver_service.numerics import ShallowWaterSolver, Snapshot, pick_device
from solver_service.runs.case_facts import CaseFacts
from solver_service.runs.edit_blobs import unpack_edits
from solver_service.runs.lineage import Leg
from solver_service.scenario import Case, load_case
from solver_service.store import StoredState


class Computation:
    """A loaded case and its solver."""

    def __init__(self, name: str, device: str, threads: int | None) -> None:
        """Load the case and put its first state on the device.

        Args:
            name: name or path of the case.
            device: "auto", "cpu" or "cuda:N".
            threads: solver threads on the CPU; None for all cores.

        Raises:
            ServiceError: the case or the device cannot be used.
        """
        self.name = name
        self.device = pick_device(device)
        self.case: Case = load_case(name)
        self.fingerprint = fingerprint(self.case)
        params = dataclasses.replace(self.case.params, threads=threads or self.case.params.threads)
        self.solver = ShallowWaterSolver(self.case.model, params, self.device)
        self.solver.set_water(self.case.initial_h)
        self._initial = self.state()
        self._wall_s = 0.0
        self._advancing_since: float | None = None

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
        )

    @property
    def depth_wet(self) -> float:
        """Depth from which a cell counts as wet [m]."""
        return self.case.params.depth_dry

    def state(self) -> StoredState:
        """The exact state at this moment."""
        snapshot = self.solver.snapshot()
        return StoredState(self.solver.time, self.solver.step_count, snapshot.arrays, snapshot.scalars)

    def restore(self, state: StoredState | None) -> None:
        """Go to a state; None is the state at time 0."""
        state = state or self._initial
        self.solver.restore(Snapshot(dict(state.arrays), dict(state.scalars)))

    def enter(self, leg: Leg) -> None:
        """Lay the bed of a leg under the water of this moment."""
        edits = unpack_edits(leg.edits)
        self.solver.replace_bed(apply_edits(self.case.z_b, edits, self.case.grid).z_b)

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
