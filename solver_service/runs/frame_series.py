"""The records of gauges and sections that belong to a frame: those after the frame before, up to its time."""

from __future__ import annotations

import numpy as np

from protocol import DecodedSeries
from solver_service.numerics import ShallowWaterSolver
from solver_service.scenario import Case

SERIES = "series"
"""Name under which series are stored, beside the channels."""


def record_count(time: float, interval: float) -> int:
    """Records that there are at a time [s]: their times are the multiples of the interval up to it."""
    count = int(time // interval) + 2
    while count > 0 and (count - 1) * interval > time:  # the very product that the solver compares
        count -= 1
    return count


def frame_series(
    case: Case, solver: ShallowWaterSolver, run: str, index: int, output_interval: float
) -> DecodedSeries | None:
    """The records of the frame at which a solver stands; None for a case without gauges and sections.

    Args:
        case: the case.
        solver: its solver, at the time of the frame.
        run: id of the run.
        index: frame index.
        output_interval: time between frames [s].
    """
    gauges = tuple(gauge.id for gauge in case.gauges)
    sections = tuple(section.id for section in case.sections)
    if not (gauges or sections):
        return None
    first = record_count((index - 1) * output_interval, case.params.gauge_interval) if index else 0
    seen, passed = solver.gauge_series(first), solver.section_series(first)
    count = len(sections)  # what follows are the lines of weirs and breaches
    return DecodedSeries(
        run=run,
        index=index,
        times=seen.times if gauges else passed.times,
        gauges=gauges,
        gauge_values=np.stack([seen.h, seen.eta, seen.u, seen.v], axis=-1),
        sections=sections,
        section_values=np.stack([passed.discharge, passed.volume, passed.area], axis=-1)[:, :count],
    )
