"""Infiltration of a model: law and parameters by zone, and the part of the step that applies them.

See `infiltration_kernels` for the laws.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt
import warp as wp

from solver_service.errors import ModelError
from solver_service.numerics.active_tiles import ActiveTiles
from solver_service.numerics.fields import Fields, FieldStore
from solver_service.numerics.infiltration_kernels import CONSTANT, GREEN_AMPT, HORTON, infiltrate
from solver_service.numerics.step_part import PartVolumes

PARAMETERS: dict[str, tuple[str, ...]] = {
    "constant": ("rate", "capacity"),
    "horton": ("f0", "fc", "k"),
    "green_ampt": ("conductivity", "suction", "deficit"),
}
"""Parameters of each law, in the order in which the kernel reads them."""

CODES = {"constant": CONSTANT, "horton": HORTON, "green_ampt": GREEN_AMPT}
MAX_ZONES = 32767
CUDA_THREADS = 1 << 18
CPU_THREADS = 1


@dataclass(frozen=True)
class Infiltration:
    """What the ground takes of the water that stands on it.

    Raises:
        ModelError: when kind, parameters or zones are not valid.
    """

    kind: Literal["constant", "horton", "green_ampt"]
    """Law: a constant rate, Horton's, or Green and Ampt's."""
    zone: npt.NDArray[np.int32] | None
    """Zone of each cell, [nrows, ncols]; None where all are zone 0."""
    parameters: Mapping[str, npt.NDArray[np.float64]]
    """Numbers of each zone, [zones]. constant: rate [m/s] and, optional, capacity [m]; horton: f0, fc [m/s]
    and k [1/s]; green_ampt: conductivity [m/s], suction [m] and deficit [1]."""

    def __post_init__(self) -> None:
        if self.kind not in PARAMETERS:
            raise ModelError(f"The infiltration is {self.kind!r}; allowed are {', '.join(PARAMETERS)}.")
        given = {name: np.atleast_1d(np.asarray(v, np.float64)) for name, v in self.parameters.items()}
        names = PARAMETERS[self.kind]
        if self.kind == "constant":
            given.setdefault("capacity", np.full_like(given.get("rate", np.zeros(1)), math.inf))
        if set(given) != set(names):
            raise ModelError(
                f"The infiltration {self.kind} has the parameters {', '.join(sorted(self.parameters))}; "
                f"{', '.join(names)} are allowed."
            )
        object.__setattr__(self, "parameters", given)
        count = given[names[0]].size
        for name in names:
            self._check_parameter(name, given[name], count)
        if self.kind == "horton" and (given["fc"] > given["f0"]).any():
            raise ModelError("The infiltration's fc lies above its f0; fc <= f0 is allowed.")
        if self.zone is not None:
            self._check_zones(count)
        elif count != 1:
            raise ModelError(
                f"The infiltration has {count} zones and no zone raster; one of both is allowed."
            )

    def _check_parameter(self, name: str, values: npt.NDArray[np.float64], count: int) -> None:
        if values.ndim != 1 or values.size != count:
            raise ModelError(
                f"The infiltration's {name} has {values.size} zones; {count}, as the others, is allowed."
            )
        highest = 1.0 if name == "deficit" else math.inf
        for zone, value in enumerate(values.tolist()):
            finite = math.isfinite(value) or (name == "capacity" and value > 0.0)
            if not (finite and 0.0 <= value <= highest):
                allowed = "0 to 1" if name == "deficit" else "a finite value >= 0"
                raise ModelError(
                    f"The infiltration's {name} of zone {zone} is {value}; {allowed} is allowed."
                )

    def _check_zones(self, count: int) -> None:
        object.__setattr__(self, "zone", np.ascontiguousarray(self.zone, np.int32))
        zone = np.atleast_2d(np.asarray(self.zone))
        bad = np.argwhere((zone < 0) | (zone >= count))
        if bad.size:
            row, col = bad[0]
            raise ModelError(
                f"The infiltration's zone is {zone[row, col]} in cell (row {row}, column {col}); "
                f"0 to {count - 1} is allowed."
            )
        if count > MAX_ZONES:
            raise ModelError(f"The infiltration has {count} zones; up to {MAX_ZONES} is allowed.")


class GroundUptake:
    """Takes from the water what infiltrates, and remembers where and how much; a `StepPart`.

    Args:
        infiltration: law and parameters.
        store: rasters of the run.
        tiles: the tiles that are computed; with infiltration every wet one.
        depth_film: water no deeper stays [m].
        depth_dry: water no deeper has no velocity [m].
        dx: cell side [m].
    """

    names = ("infiltrated", "infiltration_due")
    dt_max = math.inf

    def __init__(
        self,
        infiltration: Infiltration,
        store: FieldStore,
        tiles: ActiveTiles,
        depth_film: float,
        depth_dry: float,
        dx: float,
    ) -> None:
        self._store, self._tiles = store, tiles
        self._depth_film, self._depth_dry = depth_film, depth_dry
        self._cell_area = dx * dx
        device = store.device
        columns = [infiltration.parameters[name] for name in PARAMETERS[infiltration.kind]]
        numbers = np.zeros((columns[0].size, 3), np.float32)
        with np.errstate(over="ignore"):
            for k, column in enumerate(columns):
                numbers[:, k] = column
        zone = np.zeros((1, 1)) if infiltration.zone is None else infiltration.zone
        self._kind = int(CODES[infiltration.kind])
        self._parameters = wp.array(numbers, dtype=wp.float32, device=device)
        self._zones = wp.array(zone.astype(np.int16), dtype=wp.int16, device=device)
        shape = (store.nrows, store.ncols)
        self._infiltrated = wp.zeros(shape, dtype=wp.float32, device=device)
        self._due = wp.zeros(shape, dtype=wp.float32, device=device)
        self._threads = CUDA_THREADS if wp.get_device(device).is_cuda else CPU_THREADS

    def cells(self) -> npt.NDArray[np.bool_]:
        """None: wet tiles stay awake anyway (see `after_step`)."""
        return np.zeros((self._store.nrows, self._store.ncols), np.bool_)

    def begin(self) -> None:
        """See `StepPart.begin`."""
        self._infiltrated.zero_()
        self._due.zero_()

    def apply(self, clock: wp.array, fields: Fields) -> None:
        """See `StepPart.apply`."""
        wp.launch(
            infiltrate,
            dim=self._threads,
            inputs=[
                fields,
                clock,
                self._kind,
                self._zones,
                self._parameters,
                self._depth_film,
                self._depth_dry,
                self._store.nrows,
                self._store.ncols,
                self._tiles.tiles,
                self._tiles.count,
                self._tiles.cols,
                self._threads,
            ],
            outputs=[self._infiltrated, self._due],
            device=self._store.device,
        )

    @property
    def depth(self) -> npt.NDArray[np.float32]:
        """Depth infiltrated since the start [m], a host copy [nrows, ncols]."""
        return self._infiltrated.numpy().copy()

    def volumes(self) -> PartVolumes:
        """See `StepPart.volumes`."""
        return PartVolumes(
            infiltration=float(self._infiltrated.numpy().sum(dtype=np.float64)) * self._cell_area
        )

    def snapshot(self) -> dict[str, npt.NDArray]:
        """See `StepPart.snapshot`."""
        return {"infiltrated": self.depth, "infiltration_due": self._due.numpy().copy()}

    def restore(self, arrays: Mapping[str, npt.NDArray]) -> None:
        """See `StepPart.restore`."""
        self._infiltrated.assign(np.asarray(arrays["infiltrated"], np.float32))
        self._due.assign(np.asarray(arrays["infiltration_due"], np.float32))
