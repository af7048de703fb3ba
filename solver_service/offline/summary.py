"""The figures of a run: speed, water budget, extremes, the smallest step, and what was odd."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from protocol import GridGeometry
from solver_service.numerics import ShallowWaterSolver, VolumeBudget
from solver_service.offline.result_maps import DEPTH_SHOWN
from solver_service.scenario import Case

ERROR_ODD = 1e-5
"""A larger closing error in units of all the water [1] is told."""

UNMET_ODD = 1e-2
"""A larger part of the outflow asked for at an edge that was not there [1] is told."""


class SmallestStep:
    """Which output interval had the smallest mean step, and which cell limits it at its end.

    Args:
        grid: where the cells are.
    """

    def __init__(self, grid: GridGeometry) -> None:
        self._grid = grid
        self._time, self._steps = 0.0, 0
        self.figures: dict[str, Any] = {}

    def look(self, solver: ShallowWaterSolver) -> None:
        """Take note of the interval that ends now."""
        steps = solver.step_count - self._steps
        mean = (solver.time - self._time) / steps if steps else np.inf
        if mean < self.figures.get("dt_s", np.inf):
            row, col = solver.limiting_cell()
            x, y = self._grid.center(row, col)
            self.figures = {"dt_s": mean, "time_s": solver.time, "row": row, "col": col, "x_m": x, "y_m": y}
        self._time, self._steps = solver.time, solver.step_count


def summarise(
    case: Case, solver: ShallowWaterSolver, smallest: SmallestStep, frames: int, wall_s: float
) -> dict[str, Any]:
    """A JSON-able mapping of a run that has reached its end.

    Args:
        case: the case.
        solver: its solver.
        smallest: what was noted of the steps.
        frames: output times, the start included.
        wall_s: wall time of the time loop [s].
    """
    maxima, budget = solver.maxima(), solver.budget()
    cells, steps, time = case.grid.cell_count, solver.step_count, solver.time
    return {
        "case": case.name,
        "title": case.title,
        "hypothetical": case.hypothetical,
        "cells": cells,
        "nrows": case.grid.nrows,
        "ncols": case.grid.ncols,
        "cell_size_m": case.grid.dx,
        "steps": steps,
        "frames": frames,
        "sim_time_s": time,
        "wall_s": wall_s,
        "cell_steps_per_s": cells * steps / wall_s if wall_s > 0.0 else 0.0,
        "speed_x_real_time": time / wall_s if wall_s > 0.0 else 0.0,
        "volume_error_relative": budget.error_relative,
        "water_budget_m3": budget.as_dict(),
        "max_depth_m": float(maxima.h.max()),
        "max_speed_m_s": float(maxima.speed.max()),
        "flooded_area_m2": float(np.count_nonzero(maxima.h > DEPTH_SHOWN)) * case.grid.dx**2,
        "smallest_mean_step": smallest.figures,
        "breaches": [
            {
                "breach": state.id,
                "started_at_s": state.started_at,
                "width_m": state.width,
                "level_m": state.level + case.grid.datum_offset,
            }
            for state in solver.breach_states()
        ],
        "sections": [
            {
                "section": totals.id,
                "volume_m3": totals.volume,
                "peak_m3_s": totals.peak,
                "peak_time_s": totals.peak_time if math.isfinite(totals.peak_time) else None,
            }
            for totals in solver.section_totals()[: len(case.sections)]
        ],
        "warnings": [*case.warnings, *_odd_ends(solver, budget)],
        "device": solver.device,
        "source": case.source,
        "licence": case.licence,
    }


def _odd_ends(solver: ShallowWaterSolver, budget: VolumeBudget) -> list[str]:
    """What a run shows that its case could not."""
    told = [
        f"The breach '{state.id}' never started."
        for state in solver.breach_states()
        if state.started_at is None
    ]
    told += [
        f"The discharge '{name}' was to take out {volume:.6g} m3 more than there was at the edge."
        for name, volume in solver.unmet_outflow().items()
        if volume > UNMET_ODD * (volume + budget.edges[name][1])
    ]
    if abs(budget.error_relative) > ERROR_ODD:
        told.append(
            f"The water budget misses {budget.error:.6g} m3, {budget.error_relative:.1e} of all water."
        )
    return told
