"""[[source]]: inflows into a cell or a disc of cells."""

from __future__ import annotations

import math

import numpy as np

from solver_service.numerics import Source
from solver_service.scenario.boundaries import DISCHARGE_PER_WIDTH_MAX
from solver_service.scenario.inputs import Inputs
from solver_service.scenario.quantities import DISCHARGE
from solver_service.scenario.table import Table


def read_sources(tables: list[Table], inputs: Inputs) -> tuple[Source, ...]:
    """Inflows in their order, each with an id.

    Raises:
        CaseError: a source lies outside the terrain or on a wall, or its discharge is not valid.
    """
    sources = []
    for number, table in enumerate(tables, start=1):
        radius = table.real("radius", "a radius in m at or above 0", 0.0, 1e6, default=0.0)
        cells = np.array(inputs.disc(table, "at", radius), np.int32)
        series = inputs.series(table, "discharge", DISCHARGE)
        # The water leaves a disc of as many cells through its rim.
        rim = 2.0 * math.sqrt(math.pi * len(cells)) * inputs.grid.dx
        per_width = float(series.values.max()) / rim
        if per_width > DISCHARGE_PER_WIDTH_MAX:
            raise table.wrong(
                "discharge" if table.has("discharge") else "series",
                f"it brings {per_width:g} m2/s per metre of the rim of its {len(cells)} cells; up to"
                f" {DISCHARGE_PER_WIDTH_MAX:g} m2/s is allowed, so check the unit or give a larger radius",
            )
        sources.append(
            Source(
                cells[:, 0],
                cells[:, 1],
                series.times,
                series.values,
                id=table.text("id", f"source-{number}", longest=64),
            )
        )
    return tuple(sources)
