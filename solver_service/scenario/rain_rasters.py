"""Rain from rasters against time: a CSV of files, or a .npz with one array [time, row, column].

The rasters may be coarser than the terrain and lie as they like, as long as they cover it: each cell of the
terrain takes the rain cell that holds its centre.
"""

from __future__ import annotations

import zipfile
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from solver_service.errors import CaseError
from solver_service.numerics import Rain
from solver_service.scenario.csv_file import CsvLine, read_csv
from solver_service.scenario.inputs import Inputs
from solver_service.scenario.quantities import RAIN
from solver_service.scenario.series import Series, odd_things, time_reader
from solver_service.scenario.table import Table
from solver_service.terrain import BROKEN_ARCHIVE, Raster, format_of, read_dem, read_geotiff

MAX_VALUES = 100_000_000
"""Largest number of rain cells times times, where the terrain lies."""
Interpolation = Literal["linear", "step"]


def read_rain_files(
    table: Table, path: Path, unit: str, interpolation: Interpolation, inputs: Inputs
) -> Rain:
    """Rain from a CSV of `time_s` (or `time`), `file` and perhaps `band`.

    Args:
        table: [rain].
        path: the CSV.
        unit: unit of the rasters.
        interpolation: between their times.
        inputs: files and grid.

    Raises:
        CaseError: a line is not valid, or the rasters do not fit each other or the terrain.
        TerrainError: a raster is not valid.
    """
    columns, lines = read_csv(path)
    if not lines:
        raise CaseError(f"{path.name}: has no line of values.")
    read_time = time_reader(path.name, columns, inputs.start_time)
    times: list[float] = []
    frames: list[NDArray[np.float64]] = []
    window: _Window | None = None
    for line in lines:
        times.append(read_time(line, times[-1] if times else None))
        raster = _read_raster(line, table, unit, inputs)
        inputs.check_system(table, "series", raster)
        window = window or _Window(line.text("file"), raster, inputs)
        frames.append(window.cut(raster, line.text("file")))
        if len(lines) * frames[0].size > MAX_VALUES:
            raise line.wrong(
                f"is one of {len(lines)} rasters too many; {MAX_VALUES} values in all are allowed"
            )
    assert window is not None
    return window.rain(path.name, np.array(times), np.stack(frames), unit, interpolation)


def _read_raster(line: CsvLine, table: Table, unit: str, inputs: Inputs) -> Raster:
    said_by = f"{line.file}: line {line.number} file"
    path = inputs.folder.find(line.text("file"), said_by)
    kind = format_of(path)
    if "band" in line.columns or kind in (".tif", ".tiff"):
        band = line.real("band", 1, 1e6) if "band" in line.columns else None
        if band is not None and band != round(band):
            raise line.wrong(f"has the band {band:g}; a whole number from 1 is allowed")
        return read_geotiff(path, None if band is None else round(band), RAIN.spellings(unit))
    if kind not in (".asc", ".npz"):
        raise line.wrong(f"names the file '{path.name}'; rain in .tif, .asc or .npz is allowed")
    grid = inputs.grid
    row0 = table.choice("row0", ("south", "north"), "south")
    return read_dem(
        path, key=table.text("key", "rain"), row0=row0, cell_size=grid.dx, origin=(grid.x0, grid.y0)
    )


def read_rain_archive(
    table: Table, path: Path, unit: str, interpolation: Interpolation, inputs: Inputs
) -> Rain:
    """Rain from a .npz: the array `key` [time, row, column], `time_s`, and the scalars dx, x0, y0.

    Args:
        table: [rain].
        path: the archive.
        unit: unit of the array.
        interpolation: between its times.
        inputs: files and grid.

    Raises:
        CaseError: an array is missing or of the wrong shape, or does not fit the terrain.
    """
    key = table.text("key", "rain")
    try:
        with zipfile.ZipFile(path) as archive:
            size = sum(info.file_size for info in archive.infolist())
        if size > 8 * MAX_VALUES:
            raise CaseError(f"{path.name}: unpacks to {size} bytes; up to {8 * MAX_VALUES} are allowed.")
        with np.load(path, allow_pickle=False) as data:
            missing = [name for name in (key, "time_s", "dx", "x0", "y0") if name not in data]
            if missing:
                raise CaseError(f"{path.name}: has no array '{missing[0]}', which rain needs.")
            cube, times = np.asarray(data[key], np.float64), np.asarray(data["time_s"], np.float64)
            dx, x0, y0 = (float(data[name]) for name in ("dx", "x0", "y0"))
    except (*BROKEN_ARCHIVE, SyntaxError, TypeError) as error:
        raise CaseError(f"{path.name}: cannot be read as a NumPy archive: {error}.") from error
    if cube.ndim != 3 or times.shape != cube.shape[:1] or cube.size == 0:
        raise CaseError(
            f"{path.name}: '{key}' has the shape {cube.shape} and 'time_s' {times.shape}; [time, row, column]"
            " and as many times are allowed."
        )
    if not (np.isfinite(times).all() and (np.diff(times) > 0.0).all()):
        raise CaseError(
            f"{path.name}: 'time_s' does not increase from entry to entry; increasing times are allowed."
        )
    if not (np.isfinite((dx, x0, y0)).all() and dx > 0.0):
        raise CaseError(
            f"{path.name}: dx, x0, y0 are {dx}, {x0}, {y0}; finite numbers, dx above 0, are allowed."
        )
    if table.choice("row0", ("south", "north"), "south") == "north":
        cube = cube[:, ::-1]
    window = _Window(path.name, Raster(cube[0], x0, y0, dx, dx), inputs)
    frames = np.stack([window.cut(Raster(values, x0, y0, dx, dx), path.name) for values in cube])
    return window.rain(path.name, times, frames, unit, interpolation)


class _Window:
    """The rain cells that the terrain needs, the same of every raster."""

    def __init__(self, name: str, raster: Raster, inputs: Inputs) -> None:
        self.inputs = inputs
        self.first = name
        self.place = (raster.shape, raster.x0, raster.y0, raster.dx, raster.dy)
        grid = inputs.grid
        y = grid.y0 + (np.arange(grid.nrows) + 0.5) * grid.dx
        x = grid.x0 + (np.arange(grid.ncols) + 0.5) * grid.dx
        rows = np.floor((y - raster.y0) / raster.dy)
        cols = np.floor((x - raster.x0) / raster.dx)
        inside = rows.min() >= 0 and cols.min() >= 0
        if not (inside and rows.max() < raster.shape[0] and cols.max() < raster.shape[1]):
            theirs, ours = ([round(edge, 3) for edge in box] for box in (raster.bounds, grid.extent))
            raise CaseError(
                f"{name}: covers (xmin, ymin, xmax, ymax) {theirs} m, not the whole terrain {ours} m; rain on"
                " every cell is needed."
            )
        self.rows = slice(int(rows.min()), int(rows.max()) + 1)
        self.cols = slice(int(cols.min()), int(cols.max()) + 1)
        self.row_index = (rows - rows.min()).astype(np.int32)
        self.col_index = (cols - cols.min()).astype(np.int32)

    def cut(self, raster: Raster, name: str) -> NDArray[np.float64]:
        """The needed rain cells of a raster."""
        if (raster.shape, raster.x0, raster.y0, raster.dx, raster.dy) != self.place:
            raise CaseError(
                f"{name}: lies on other cells than {self.first}; the same cells for all are allowed."
            )
        return np.asarray(raster.values[self.rows, self.cols], np.float64)

    def rain(
        self,
        name: str,
        times: NDArray[np.float64],
        frames: NDArray[np.float64],
        unit: str,
        interpolation: Interpolation,
    ) -> Rain:
        """The rain, checked."""
        scale = RAIN.units[unit]
        low, high = (limit * RAIN.units[RAIN.unit] for limit in (RAIN.low, RAIN.high))
        rates = frames * scale
        bad = ~((rates >= low) & (rates <= high))
        if bad.any():
            k, row, col = np.argwhere(bad)[0].tolist()
            raise CaseError(
                f"{name}: the rain at {times[k]:g} s is {frames[k, row, col]:g} {unit} in its cell (row"
                f" {row + self.rows.start}, column {col + self.cols.start}); {RAIN.low:g} to {RAIN.high:g}"
                f" {RAIN.unit} in every cell is allowed, so check unit and holes."
            )
        largest = Series(times, rates.max(axis=(1, 2)))
        self.inputs.warnings.extend(odd_things(name, largest, RAIN, self.inputs.duration))
        return Rain(times, rates, self.row_index, self.col_index, interpolation)
