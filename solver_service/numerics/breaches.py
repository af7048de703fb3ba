"""The breaches of a model on its device: they grow after every step and eat the bed."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
import numpy.typing as npt
import warp as wp

from solver_service.errors import ModelError
from solver_service.numerics.breach import Breach, BreachState
from solver_service.numerics.breach_kernels import (
    LEVEL,
    NOT_STARTED,
    STARTED,
    STATE_COUNT,
    WIDTH,
    grow_breaches,
    lower_bed,
    read_bed,
)
from solver_service.numerics.fields import GHOSTS, Fields, FieldStore
from solver_service.numerics.friction import GRAVITY
from solver_service.numerics.step_part import PartVolumes


def _numbers(breach: Breach, dx: float) -> list[float]:
    """In the order of `breach_kernels`."""
    gravity, critical = float(GRAVITY), breach.critical_velocity
    return [
        breach.start_time,
        float(breach.start == "overtopping"),
        breach.crest,
        breach.bottom_level,
        breach.duration,
        breach.width_initial,
        breach.widest(dx),
        float(breach.law == "linear"),
        breach.f1 * math.sqrt(gravity) / critical,
        breach.f2 * gravity / critical,
        breach.side_slope,
    ]


class Breaches:
    """Lets breaches grow; a `StepPart`. The bed they have eaten is that of the model or its edits, cut.

    Args:
        breaches: what grows, at least one.
        store: rasters of the run; its bed is that without breaches.
        dx: cell side [m].
        depth_dry: depth from which water counts [m].

    Raises:
        ModelError: when two breaches share a cell.
    """

    names = ("breach_states", "breach_ground")
    dt_max = math.inf

    def __init__(self, breaches: tuple[Breach, ...], store: FieldStore, dx: float, depth_dry: float) -> None:
        self._breaches = breaches
        self._store = store
        self._dx = dx
        self._depth_dry = depth_dry
        shape = (store.nrows, store.ncols)
        footprints = [breach.footprint(shape, dx) for breach in breaches]
        self._cells = np.concatenate([cells for cells, _ in footprints])
        owners = np.repeat(np.arange(len(breaches)), [len(cells) for cells, _ in footprints])
        self._refuse_shared_cells(owners)
        device = store.device
        self._numbers = wp.array([_numbers(b, dx) for b in breaches], dtype=wp.float64, device=device)
        probes = np.array([breach.probes(dx) for breach in breaches], np.int32).reshape(-1, 4) + GHOSTS
        self._probes = wp.array(probes, dtype=wp.int32, device=device)
        self._owners = wp.array(owners, dtype=wp.int32, device=device)
        self._padded = wp.array(self._cells + GHOSTS, dtype=wp.int32, device=device)
        along = np.concatenate([along for _, along in footprints])
        self._along = wp.array(along, dtype=wp.float64, device=device)
        self._ground = wp.zeros(len(self._cells), dtype=wp.float32, device=device)
        self._bed = wp.zeros_like(self._ground)
        self._states = wp.array(self._first_states(), dtype=wp.float64, device=device)
        self.take_ground()

    def _refuse_shared_cells(self, owners: npt.NDArray[np.int64]) -> None:
        taken: dict[tuple[int, int], int] = {}
        for owner, (row, col) in zip(owners.tolist(), self._cells.tolist(), strict=True):
            other = taken.setdefault((row, col), owner)
            if other != owner:
                first, second = self._breaches[other].id, self._breaches[owner].id
                raise ModelError(
                    f"The breaches {first!r} and {second!r} both reach cell (row {row}, column {col});"
                    " each cell in one breach is allowed."
                )

    def cells(self) -> npt.NDArray[np.bool_]:
        """Everything that a breach may ever eat."""
        mask = np.zeros((self._store.nrows, self._store.ncols), np.bool_)
        mask[self._cells[:, 0], self._cells[:, 1]] = True
        return mask

    def take_ground(self) -> None:
        """Take the bed of the store for ground that is not eaten, and eat what the breaches have reached."""
        self._ground.assign(self._store.read("z")[self._cells[:, 0], self._cells[:, 1]])
        self._lower(self._store.arrays["z"])

    def begin(self) -> None:
        """See `StepPart.begin`: nothing is eaten."""
        self._states.assign(self._first_states())
        self._lower(self._store.arrays["z"])

    def _first_states(self) -> npt.NDArray[np.float64]:
        states = np.zeros((len(self._breaches), STATE_COUNT))
        states[:, int(STARTED)] = float(NOT_STARTED)
        states[:, int(LEVEL)] = [breach.crest for breach in self._breaches]
        return states

    def apply(self, clock: wp.array, fields: Fields) -> None:
        """See `StepPart.apply`."""
        wp.launch(
            grow_breaches,
            dim=len(self._breaches),
            inputs=[clock, fields.h_out, fields.z, self._numbers, self._probes, self._depth_dry],
            outputs=[self._states],
            device=self._store.device,
        )
        self._lower(fields.z)

    def _lower(self, z: wp.array) -> None:
        wp.launch(
            lower_bed,
            dim=len(self._cells),
            inputs=[
                self._numbers,
                self._states,
                self._owners,
                self._padded,
                self._along,
                self._ground,
                self._dx,
            ],
            outputs=[z],
            device=self._store.device,
        )

    def states(self) -> tuple[BreachState, ...]:
        """How far each breach has grown."""
        shown = []
        for breach, numbers in zip(self._breaches, self._states.numpy().tolist(), strict=True):
            started = numbers[int(STARTED)]
            begun = started != float(NOT_STARTED)
            shown.append(
                BreachState(breach.id, started if begun else None, numbers[int(WIDTH)], numbers[int(LEVEL)])
            )
        return tuple(shown)

    def lowered(self) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.float32]]:
        """Cells that stand below their ground now, as row x ncols + col, rising, and their bed [m]."""
        wp.launch(
            read_bed,
            dim=len(self._cells),
            inputs=[self._store.arrays["z"], self._padded],
            outputs=[self._bed],
            device=self._store.device,
        )
        bed = self._bed.numpy()
        eaten = bed < self._ground.numpy()
        places = self._cells[eaten, 0].astype(np.int64) * self._store.ncols + self._cells[eaten, 1]
        order = np.argsort(places)
        return places[order], bed[eaten][order]

    def volumes(self) -> PartVolumes:
        """Nothing: water stays where the bed sinks."""
        return PartVolumes()

    def snapshot(self) -> dict[str, npt.NDArray]:
        """States of the breaches, and the ground of their cells without them."""
        return {
            "breach_states": self._states.numpy().copy(),
            "breach_ground": self._ground.numpy().copy(),
        }

    def restore(self, arrays: Mapping[str, npt.NDArray]) -> None:
        """See `StepPart.restore`."""
        self._states.assign(np.asarray(arrays["breach_states"], np.float64))
        self._ground.assign(np.asarray(arrays["breach_ground"], np.float32))
        self._lower(self._store.arrays["z"])
