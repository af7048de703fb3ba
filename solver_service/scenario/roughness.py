"""[roughness] and [[roughness.zone]]: Manning's n from a number, a raster, land cover, zones."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from solver_service.errors import CaseError
from solver_service.scenario.classes import read_classes
from solver_service.scenario.inputs import Inputs
from solver_service.scenario.table import Table

MANNING_MAX = 1.0
MANNING_ODD = 0.5
"""A larger roughness [s m^(-1/3)] is told as odd: perhaps it is a Strickler value or another law."""
ALLOWED = f"a Manning roughness from 0 to {MANNING_MAX:g} s m^(-1/3)"


def read_roughness(table: Table, inputs: Inputs) -> float | NDArray[np.float32]:
    """Manning's n [s m^(-1/3)]: one number, or one for each cell.

    Raises:
        CaseError: nothing is given, or a value is out of range.
        TerrainError: a raster is not valid.
    """
    given = [key for key in ("manning_n", "raster", "classes") if table.has(key)]
    if len(given) != 1:
        raise CaseError(
            f"{table.file}: [roughness] has {' and '.join(given) or 'no value'}; one of manning_n, raster,"
            " classes is allowed."
        )
    table.only_beside("key", "raster")
    table.only_beside("row0", "raster", "classes")
    table.only_beside("table", "classes")
    if given == ["raster"]:
        values = _raster(table, inputs)
    elif given == ["classes"]:
        line, columns = read_classes(table, inputs, {"manning_n": (0.0, MANNING_MAX)})
        values = columns["manning_n"][line].astype(np.float32)
    else:
        everywhere = table.real("manning_n", ALLOWED, 0.0, MANNING_MAX)
        if not table.has("zone"):
            _tell_odd(everywhere, inputs)
            return everywhere
        values = np.full(inputs.grid.shape, everywhere, np.float32)
    for zone in table.tables("zone"):
        values[inputs.covered(zone)] = zone.real("manning_n", ALLOWED, 0.0, MANNING_MAX)
    _tell_odd(float(values.max()), inputs)
    return values


def _raster(table: Table, inputs: Inputs) -> NDArray[np.float32]:
    values = inputs.raster(table, "raster", table.text("key", "manning_n"), "nearest")
    bad = ~((values >= 0.0) & (values <= MANNING_MAX)) & ~inputs.terrain.wall
    if bad.any():
        row, col = np.argwhere(bad)[0].tolist()
        raise table.wrong(
            "raster", f"its cell (row {row}, column {col}) holds {values[row, col]:g}; {ALLOWED} is"
        )
    return np.where(inputs.terrain.wall & ~(values >= 0.0), np.float32(0.0), values)


def _tell_odd(largest: float, inputs: Inputs) -> None:
    if largest > MANNING_ODD:
        inputs.warnings.append(f"[roughness] reaches n = {largest:g}; is it really Manning's n?")
