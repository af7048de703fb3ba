"""The maps that a run leaves: what the flood was at its worst, and when."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from solver_service.numerics import Maxima, ShallowWaterSolver
from solver_service.offline.maps import write_map
from solver_service.scenario import Case

DEPTH_SHOWN = 1e-3
"""Depth [m] from which a map shows a cell."""

FloatRaster = NDArray[np.float32]
Map = tuple[str, FloatRaster, str, str]
"""File name without suffix, values, unit, meaning."""


def write_maps(folder: Path, case: Case, solver: ShallowWaterSolver) -> None:
    """Write all maps of a run; cells that stayed dry hold no value.

    Raises:
        OSError: a file cannot be written.
    """
    for name, values, unit, meaning in _maps_of_maxima(solver.maxima(), case.params.depth_arrival):
        write_map(folder / f"{name}.tif", values, case.grid, unit, meaning)
    infiltrated = solver.infiltrated()
    if infiltrated is not None:
        shown = np.where(infiltrated > 0.0, infiltrated, np.float32(np.nan))
        write_map(folder / "infiltration.tif", shown, case.grid, "m", "depth that the ground has taken")


def _maps_of_maxima(maxima: Maxima, depth_arrival: float) -> Iterator[Map]:
    wet = maxima.h > DEPTH_SHOWN

    def where_wet(values: FloatRaster) -> FloatRaster:
        return np.where(wet, values, np.float32(np.nan)).astype(np.float32)

    yield "max_depth", where_wet(maxima.h), "m", "largest depth"
    yield "max_speed", where_wet(maxima.speed), "m/s", "largest speed where deeper than 0.05 m"
    yield "max_hazard", where_wet(maxima.hazard), "", "largest hazard rating d (v + 0.5) + DF"
    yield "time_of_max", where_wet(maxima.time_of_max), "s", "time of the largest depth"
    yield "arrival_time", maxima.arrival_time, "s", f"first time deeper than {depth_arrival:g} m"
    yield "wet_duration", where_wet(maxima.wet_duration), "s", f"time deeper than {depth_arrival:g} m"
    yield "rise_rate", where_wet(maxima.rise_rate_max), "m/s", "fastest rise of the depth"
    for depth, times in maxima.arrival_by_class.items():
        yield arrival_name(depth), times, "s", f"first time deeper than {depth:g} m"


def arrival_name(depth: float) -> str:
    """File name, without suffix, of the arrival times of a depth class [m]: arrival_0_15m for 0.15."""
    return f"arrival_{depth:g}m".replace(".", "_")
