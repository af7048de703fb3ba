"""Depth and water level against time as NetCDF (CF-1.11) and Zarr v3, written frame by frame.

The level is that of the ground of its time, so that level - depth is the bed wherever there is water, also
where a breach or an edit has changed it since the start.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from protocol import GridGeometry
from solver_service.scenario import Case

LOCAL = "local"
DEPTH_NAME = "flood_water_thickness"
LEVEL_NAME = "water_surface_height_above_reference_datum"
NEVER = "seconds since 1970-01-01 00:00:00+00:00"


@dataclass(frozen=True)
class TimestepFacts:
    """What stands beside the depths.

    Attributes:
        grid: where the cells are.
        bed: ground at the start [m, relative to grid.datum_offset].
        title: one line for people.
        source: where the data comes from.
        licence: licence of the data.
        hypothetical: whether the event never happened.
        start_time: clock time of time 0, ISO 8601 with offset; None where it has none.
        depth_wet: depth from which a cell has a water level [m].
    """

    grid: GridGeometry
    bed: NDArray[np.float32]
    title: str
    source: str
    licence: str
    hypothetical: bool
    start_time: str | None
    depth_wet: float

    @staticmethod
    def of(case: Case) -> TimestepFacts:
        """The facts of a case."""
        about = (case.title, case.source, case.licence, case.hypothetical, case.start_time)
        return TimestepFacts(case.grid, case.z_b, *about, case.params.depth_dry)

    def level(self, h: NDArray[np.float32], bed: NDArray[np.float32]) -> NDArray[np.float32]:
        """Elevation of the water [m], NaN where it is dry, for a depth and the bed of its time [m]."""
        offset = np.float32(self.grid.datum_offset)
        return np.where(h >= np.float32(self.depth_wet), (bed + h) + offset, np.float32(np.nan))


class TimestepWriter(Protocol):
    """Takes the frames of a run in order."""

    def append(self, time: float, h: NDArray[np.float32], bed: NDArray[np.float32]) -> None:
        """Add depth and bed [m, relative to grid.datum_offset] at a time [s]."""

    def close(self) -> None:
        """Finish the file."""


def _centres(grid: GridGeometry) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    x: NDArray[np.float64] = grid.x0 + (np.arange(grid.ncols, dtype=np.float64) + 0.5) * grid.dx
    y: NDArray[np.float64] = grid.y0 + (np.arange(grid.nrows, dtype=np.float64) + 0.5) * grid.dx
    return x, y


def _wkt(grid: GridGeometry) -> str | None:
    if grid.crs == LOCAL:
        return None
    from pyproj import CRS

    return str(CRS.from_user_input(grid.crs).to_wkt())


def _time_unit(facts: TimestepFacts) -> str:
    return f"seconds since {facts.start_time}" if facts.start_time else NEVER


class NetcdfTimesteps:
    """One NetCDF file: `depth(time, y, x)`, `level(time, y, x)` and `bed(y, x)`, from south to north."""

    def __init__(self, path: Path, facts: TimestepFacts) -> None:
        """Begin the file.

        Args:
            path: the file.
            facts: what stands beside the depths.
        """
        import netCDF4

        self._facts, grid = facts, facts.grid
        self._file: Any = netCDF4.Dataset(str(path), "w", format="NETCDF4")
        file = self._file
        file.Conventions = "CF-1.11"
        file.title, file.source, file.license = facts.title, facts.source, facts.licence
        file.comment = "hypothetical" if facts.hypothetical else "historical or laboratory event"
        for name, size in (("time", None), ("y", grid.nrows), ("x", grid.ncols)):
            file.createDimension(name, size)
        time = file.createVariable("time", "f8", ("time",))
        time.units, time.standard_name, time.calendar = _time_unit(facts), "time", "standard"
        for name, values in zip("xy", _centres(grid), strict=True):
            axis = file.createVariable(name, "f8", (name,))
            axis.units, axis.standard_name, axis.axis = "m", f"projection_{name}_coordinate", name.upper()
            axis[:] = values
        wkt = _wkt(grid)
        if wkt is not None:
            file.createVariable("crs", "i4", ()).crs_wkt = wkt
        packed: dict[str, Any] = {"zlib": True, "complevel": 1, "shuffle": True}
        chunks = (1, min(grid.nrows, 512), min(grid.ncols, 512))
        depth = file.createVariable("depth", "f4", ("time", "y", "x"), chunksizes=chunks, **packed)
        depth.units, depth.standard_name = "m", DEPTH_NAME
        nan = np.float32(np.nan)
        level = file.createVariable(
            "level", "f4", ("time", "y", "x"), chunksizes=chunks, fill_value=nan, **packed
        )
        level.units, level.standard_name = "m", LEVEL_NAME
        bed = file.createVariable("bed", "f4", ("y", "x"), **packed)
        bed.units, bed.standard_name, bed.long_name = "m", "surface_altitude", "ground at the start"
        bed[:] = facts.bed + np.float32(grid.datum_offset)
        for variable in (depth, level, bed):
            if wkt is not None:
                variable.grid_mapping = "crs"

    def append(self, time: float, h: NDArray[np.float32], bed: NDArray[np.float32]) -> None:
        """Add depth and bed [m, relative to grid.datum_offset] at a time [s]."""
        number = self._file.variables["time"].shape[0]
        self._file.variables["time"][number] = time
        self._file.variables["depth"][number] = h
        self._file.variables["level"][number] = self._facts.level(h, bed)

    def close(self) -> None:
        """Finish the file."""
        self._file.close()


class ZarrTimesteps:
    """One Zarr v3 group with the same: `depth`, `level`, `bed`, `time`, `y`, `x`, from south to north."""

    def __init__(self, path: Path, facts: TimestepFacts) -> None:
        """Begin the group.

        Args:
            path: its folder.
            facts: what stands beside the depths.
        """
        import zarr

        self._facts, grid = facts, facts.grid
        self._times: list[float] = []
        self._group: Any = zarr.open_group(str(path), mode="w", zarr_format=3)
        group = self._group
        group.attrs.update(
            {
                "title": facts.title,
                "source": facts.source,
                "licence": facts.licence,
                "hypothetical": facts.hypothetical,
                "crs_wkt": _wkt(grid),
            }
        )
        self._series = {
            name: group.create_array(
                name,
                shape=(0, *grid.shape),
                chunks=(1, min(grid.nrows, 512), min(grid.ncols, 512)),
                dtype="float32",
                fill_value=fill,
                dimension_names=("time", "y", "x"),
                attributes={"units": "m", "standard_name": standard_name},
            )
            for name, fill, standard_name in (
                ("depth", 0.0, DEPTH_NAME),
                ("level", float("nan"), LEVEL_NAME),
            )
        }
        bed = (facts.bed + np.float32(grid.datum_offset)).astype(np.float32)
        self._write("bed", bed, ("y", "x"), {"units": "m", "standard_name": "surface_altitude"})
        for name, values in zip("xy", _centres(grid), strict=True):
            self._write(name, values, (name,), {"units": "m"})
        self._unit = _time_unit(facts)

    def _write(
        self, name: str, values: NDArray[Any], dims: tuple[str, ...], attributes: dict[str, str]
    ) -> None:
        array = self._group.create_array(
            name, shape=values.shape, dtype=values.dtype, dimension_names=dims, attributes=attributes
        )
        array[...] = values

    def append(self, time: float, h: NDArray[np.float32], bed: NDArray[np.float32]) -> None:
        """Add depth and bed [m, relative to grid.datum_offset] at a time [s]."""
        self._times.append(time)
        for name, values in (("depth", h), ("level", self._facts.level(h, bed))):
            self._series[name].resize((len(self._times), *h.shape))
            self._series[name][len(self._times) - 1] = values

    def close(self) -> None:
        """Finish the group: the times."""
        self._write("time", np.array(self._times), ("time",), {"units": self._unit})
