"""The culverts and pumps of a model on its device; see `conduit_kernels` for what they do."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import warp as wp

from solver_service.numerics.conduit_kernels import (
    CARRIED,
    CULVERT,
    DISCHARGE,
    MOVED,
    PUMP,
    RUNNING,
    STATE_COUNT,
    run_conduits,
)
from solver_service.numerics.fields import GHOSTS, Fields, FieldStore
from solver_service.numerics.friction import GRAVITY
from solver_service.numerics.step_part import PartVolumes
from solver_service.numerics.structures import Culvert, Pump

Conduit = Culvert | Pump


@dataclass(frozen=True)
class ConduitState:
    """What a culvert or pump does."""

    id: str
    """Name of the structure."""
    discharge: float
    """Discharge in the last step, from inlet to outlet [m3/s]; negative the other way."""
    moved: float
    """Volume moved from inlet to outlet since the start, less that moved back [m3]."""
    is_running: bool
    """Whether a pump runs; True for culverts."""


def _numbers(conduit: Conduit) -> list[float]:
    """In the order of `conduit_kernels`."""
    if isinstance(conduit, Culvert):
        size = [conduit.width, conduit.height, float(conduit.barrels)]
        losses = [conduit.loss, conduit.orifice_coefficient, float(conduit.both_ways)]
        return [float(CULVERT), conduit.invert_inlet, conduit.invert_outlet, *size, *losses, 0.0, 0.0, 0.0]
    start = -math.inf if conduit.start_level is None else conduit.start_level
    stop = -math.inf if conduit.stop_level is None else conduit.stop_level
    return [float(PUMP), *[0.0] * 8, float(conduit.rating_against == "head"), start, stop]


def _grouped(conduits: tuple[Conduit, ...]) -> list[list[Conduit]]:
    """The structures by groups that share no cell, in their order."""
    groups: list[tuple[set[tuple[int, int]], list[int]]] = []
    for number, conduit in enumerate(conduits):
        cells, members = set(conduit.inlet + (conduit.outlet or ())), [number]
        apart = []
        for group in groups:
            if group[0] & cells:
                cells |= group[0]
                members += group[1]
            else:
                apart.append(group)
        groups = [*apart, (cells, members)]
    return [[conduits[number] for number in sorted(members)] for _, members in groups]


class Conduits:
    """Runs culverts and pumps; a `StepPart`.

    Args:
        conduits: culverts and pumps, at least one.
        store: rasters of the run.
        dx: cell side [m].
        cfl: Courant number of the scheme.
        depth_dry: water no deeper has no velocity [m].
    """

    names = ("conduit_states",)

    def __init__(
        self, conduits: tuple[Conduit, ...], store: FieldStore, dx: float, cfl: float, depth_dry: float
    ) -> None:
        self._store = store
        self._cell_area = dx * dx
        self._depth_dry = depth_dry
        groups = _grouped(conduits)
        self._conduits = [conduit for group in groups for conduit in group]
        self._cells = np.array(
            [cell for conduit in self._conduits for cell in conduit.inlet + (conduit.outlet or ())], np.int32
        )
        self.dt_max = min(self._largest_step(conduit, dx, cfl) for conduit in self._conduits)
        sizes = [[len(conduit.inlet), len(conduit.outlet or ())] for conduit in self._conduits]
        firsts = np.concatenate([[0], np.cumsum(sizes)])
        ends = np.stack([firsts[0:-1:2], firsts[1::2], firsts[2::2]], axis=1)
        ratings = [conduit.rating if isinstance(conduit, Pump) else () for conduit in self._conduits]
        rates = [conduit.discharge if isinstance(conduit, Pump) else () for conduit in self._conduits]
        self._group_count = len(groups)
        self._groups = self._to_device(np.cumsum([0, *map(len, groups)]), wp.int32)
        self._numbers = self._to_device(np.array([_numbers(c) for c in self._conduits]), wp.float64)
        self._ends = self._to_device(ends, wp.int32)
        self._padded = self._to_device(self._cells + GHOSTS, wp.int32)
        self._rating_first = self._to_device(np.cumsum([0, *map(len, ratings)]), wp.int32)
        self._ratings = self._to_device(np.concatenate([*ratings, ()]), wp.float64)
        self._rates = self._to_device(np.concatenate([*rates, ()]), wp.float64)
        self._states = self._to_device(np.zeros((len(self._conduits), STATE_COUNT)), wp.float64)

    def _to_device(self, values: npt.NDArray, dtype: type) -> wp.array:
        return wp.array(values, dtype=dtype, device=self._store.device)

    @staticmethod
    def _largest_step(conduit: Conduit, dx: float, cfl: float) -> float:
        """Time in which what a pump gives spreads over cfl cells [s]."""
        if isinstance(conduit, Culvert) or conduit.outlet is None:
            return math.inf
        per_width = max(conduit.discharge) / (math.sqrt(len(conduit.outlet)) * dx)
        speed = 2.0 * (float(GRAVITY) * per_width) ** (1.0 / 3.0)
        return cfl * dx / speed if speed > 0.0 else math.inf

    def cells(self) -> npt.NDArray[np.bool_]:
        """Inlets and outlets."""
        mask = np.zeros((self._store.nrows, self._store.ncols), np.bool_)
        mask[self._cells[:, 0], self._cells[:, 1]] = True
        return mask

    def begin(self) -> None:
        """See `StepPart.begin`: nothing has moved, and no pump runs."""
        self._states.zero_()

    def apply(self, clock: wp.array, fields: Fields) -> None:
        """See `StepPart.apply`."""
        wp.launch(
            run_conduits,
            dim=self._group_count,
            inputs=[
                clock,
                self._groups,
                self._numbers,
                self._ends,
                self._padded,
                self._rating_first,
                self._ratings,
                self._rates,
                self._cell_area,
                self._depth_dry,
                fields.z,
            ],
            outputs=[fields.h_out, fields.u_out, fields.v_out, self._states],
            device=self._store.device,
        )

    def states(self) -> tuple[ConduitState, ...]:
        """What each culvert and pump does."""
        return tuple(
            ConduitState(
                conduit.id,
                numbers[int(DISCHARGE)],
                numbers[int(MOVED)],
                isinstance(conduit, Culvert) or numbers[int(RUNNING)] == 1.0,
            )
            for conduit, numbers in zip(self._conduits, self._states.numpy().tolist(), strict=True)
        )

    def volumes(self) -> PartVolumes:
        """What was moved; out of the domain is what a pump without outlet took or a conduit still holds."""
        structures, moved = {}, {}
        for conduit, numbers in zip(self._conduits, self._states.numpy().tolist(), strict=True):
            moved[conduit.id] = numbers[int(MOVED)]
            structures[conduit.id] = numbers[int(CARRIED)] if conduit.outlet else numbers[int(MOVED)]
        return PartVolumes(structures=structures, moved=moved)

    def snapshot(self) -> dict[str, npt.NDArray]:
        """What is due, carried, moved, running and flowing in each structure, float64."""
        return {"conduit_states": self._states.numpy().copy()}

    def restore(self, arrays: Mapping[str, npt.NDArray]) -> None:
        """See `StepPart.restore`."""
        self._states.assign(np.asarray(arrays["conduit_states"], np.float64))
