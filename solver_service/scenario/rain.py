"""[rain]: one series for all cells, or rasters against time with a georeference of their own."""

from __future__ import annotations

from typing import Literal

from solver_service.numerics import Rain
from solver_service.scenario.csv_file import read_csv
from solver_service.scenario.inputs import Inputs
from solver_service.scenario.quantities import RAIN
from solver_service.scenario.rain_rasters import read_rain_archive, read_rain_files
from solver_service.scenario.table import Table


def read_rain(table: Table | None, inputs: Inputs) -> Rain | None:
    """Rain on the cells; None without rain.

    A series whose second column is `file`, or a .npz, brings rasters.

    Raises:
        CaseError: a key or a series is not valid.
        TerrainError: a raster is not valid.
    """
    if table is None:
        return None
    unit = table.choice("unit", tuple(RAIN.units), RAIN.unit)
    table.only_beside("key", "series")
    table.only_beside("row0", "series")
    declared = unit if table.has("unit") else None
    if table.has("series") and not table.has("rate"):
        path = inputs.file(table, "series")
        if path.suffix.lower() == ".npz":
            return read_rain_archive(table, path, unit, _interpolation(table, "step"), inputs)
        if "file" in read_csv(path)[0]:
            return read_rain_files(table, path, unit, _interpolation(table, "step"), inputs)
        if table.has("key") or table.has("row0"):
            raise table.wrong(
                "key" if table.has("key") else "row0", "it is allowed where series brings rasters"
            )
    series = inputs.series(table, "rate", RAIN, declared)
    return Rain.uniform(series.times, series.values, inputs.grid.shape, _interpolation(table, "linear"))


def _interpolation(table: Table, default: str) -> Literal["linear", "step"]:
    return "linear" if table.choice("interpolation", ("linear", "step"), default) == "linear" else "step"
