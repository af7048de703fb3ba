"""[infiltration] and [[infiltration.zone]]: water that the ground takes, by one law with values by zone."""

from __future__ import annotations

from typing import Literal, cast

import numpy as np

from solver_service.errors import CaseError
from solver_service.numerics import Infiltration
from solver_service.scenario.classes import read_classes
from solver_service.scenario.inputs import Inputs
from solver_service.scenario.table import Table

MM_PER_HOUR = 1e-3 / 3600.0
"""[m/s]"""
MAX_ZONES = 10_000

Model = Literal["constant", "horton", "green_ampt"]
Value = tuple[str, float, float, float, str]
"""Name in numerics, SI value of 1 of the case's unit, smallest and largest value, these in words."""
RATE = "a rate in mm/h from 0 to 10000"
MODELS: dict[str, dict[str, Value]] = {
    "constant": {
        "rate": ("rate", MM_PER_HOUR, 0.0, 1e4, RATE),
        "capacity": ("capacity", 1e-3, 0.0, 1e6, "a depth in mm from 0 to 1000000"),
    },
    "horton": {
        "rate_initial": ("f0", MM_PER_HOUR, 0.0, 1e4, RATE),
        "rate_final": ("fc", MM_PER_HOUR, 0.0, 1e4, RATE),
        "decay": ("k", 1.0 / 3600.0, 0.0, 1e4, "a decay in 1/h from 0 to 10000"),
    },
    "green_ampt": {
        "conductivity": ("conductivity", MM_PER_HOUR, 0.0, 1e4, "a conductivity in mm/h from 0 to 10000"),
        "suction": ("suction", 1e-3, 0.0, 1e4, "a suction head in mm from 0 to 10000"),
        "deficit": ("deficit", 1.0, 0.0, 1.0, "a moisture deficit from 0 to 1"),
    },
}
"""Keys of each model."""
OPTIONAL = frozenset({"capacity"})
"""Without a capacity the ground takes water for ever."""


def read_infiltration(table: Table | None, inputs: Inputs) -> Infiltration | None:
    """The law and its values by zone; None without infiltration.

    Raises:
        CaseError: a key is missing, not one of the model, or out of range.
        TerrainError: the raster of classes is not valid.
    """
    if table is None:
        return None
    model = cast(Model, table.choice("model", tuple(MODELS)))
    keys = MODELS[model]
    table.only_beside("table", "classes")
    table.only_beside("row0", "classes")
    for other in (key for values in MODELS.values() for key in values if key not in keys):
        for place in (table, *table.tables("zone")):
            if place.has(other):
                raise place.wrong(other, f"{', '.join(keys)} are the keys of model '{model}'")
    zone = np.zeros(inputs.grid.shape, np.int32)
    if table.has("classes"):
        given = [key for key in keys if table.has(key)]
        if given:
            raise table.wrong(given[0], "it is not allowed beside classes, whose table brings the values")
        wanted = {key: value[2:4] for key, value in keys.items() if key not in OPTIONAL}
        zone, columns = read_classes(table, inputs, wanted)
        values = {key: columns[key].tolist() for key in wanted}
        values |= {key: [np.inf] * len(values[next(iter(wanted))]) for key in keys if key in OPTIONAL}
    else:
        values = {key: [_value(table, key, value)] for key, value in keys.items()}
    for item in table.tables("zone"):
        inside = inputs.covered(item)
        zone[inside] = len(next(iter(values.values())))
        for key, value in keys.items():
            values[key].append(_value(item, key, value))
    parameters = {keys[key][0]: np.array(found) * keys[key][1] for key, found in values.items()}
    if model == "horton" and (parameters["fc"] > parameters["f0"]).any():
        raise CaseError(
            f"{table.file}: [infiltration] has a rate_final above its rate_initial; a fall is allowed."
        )
    if model == "constant" and np.isinf(parameters["capacity"]).all():
        del parameters["capacity"]
    uniform = len(next(iter(values.values()))) == 1
    return Infiltration(model, None if uniform else zone, parameters)


def _value(table: Table, key: str, value: Value) -> float:
    _, _, low, high, allowed = value
    if key in OPTIONAL and not table.has(key):
        return float("inf")
    return table.real(key, allowed, low, high)
