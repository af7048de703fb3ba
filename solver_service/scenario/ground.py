"""The ground of a case: [terrain], [[terrain.raise]] and [roughness]."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from protocol import GridGeometry
from solver_service.errors import CaseError, TerrainError
from solver_service.scenario.case_folder import CaseFolder
from solver_service.scenario.table import Table
from solver_service.terrain import (
    LOCAL,
    Raster,
    Ring,
    Terrain,
    cells_inside,
    centre_of,
    check_metres,
    check_ring,
    crop,
    is_geographic,
    make_terrain,
    read_dem,
    read_polygons,
    reproject,
    resample,
    same_crs,
    sample,
)

MANNING_MAX = 1.0


@dataclass(frozen=True)
class GroundKeys:
    """[terrain] and [case] crs, checked but for the files they name.

    Attributes:
        table: [terrain].
        crs: [case] crs; None where the file decides.
        vertical_datum: [case] vertical_datum.
        cell_size: cell size asked for, in the case file or instead of it [m].
        native_size: [terrain] cell_size, which stands for the file's own where it has none [m].
        bounds: part of the terrain to keep.
    """

    table: Table
    crs: str | None
    vertical_datum: str
    cell_size: float | None
    native_size: float | None
    bounds: tuple[float, float, float, float] | None


def read_ground_keys(terrain: Table, case: Table, cell_size: float | None) -> GroundKeys:
    """Check what can be checked before any file is read.

    Raises:
        CaseError: naming table, key, value and what is allowed.
    """
    bounds = None
    if terrain.has("bounds"):
        xmin, ymin, xmax, ymax = terrain.numbers("bounds", 4)
        if not (xmin < xmax and ymin < ymax):
            raise terrain.wrong(
                "bounds", "[xmin, ymin, xmax, ymax] with xmin < xmax and ymin < ymax is allowed"
            )
        bounds = (xmin, ymin, xmax, ymax)
    native = terrain.number_or_none("cell_size", "a cell size in m from 0.001 to 100000", 1e-3, 1e5)
    return GroundKeys(
        table=terrain,
        crs=case.text("crs", longest=200) if case.has("crs") else None,
        vertical_datum=case.text("vertical_datum", "", longest=200),
        cell_size=cell_size or native,
        native_size=native,
        bounds=bounds,
    )


def read_ground(keys: GroundKeys, folder: CaseFolder) -> Terrain:
    """Read, reproject, resample and raise the terrain.

    Raises:
        CaseError: a key is not valid.
        TerrainError: a file is not valid.
    """
    table = keys.table
    name = table.text("dem")
    path = folder.find(name, f"{table.file}: [terrain] dem")
    raster = read_dem(
        path,
        key=table.text("key") if table.has("key") else "bed",
        row0=table.choice("row0", ("south", "north"), "south"),
        cell_size=(keys.cell_size if ".slf" in name.lower() else keys.native_size),
        origin=(table.point("origin") if table.has("origin") else None),
        bounds=None if table.has("reproject") else keys.bounds,
    )
    raster, crs = _projected(raster, keys)
    nodata_value = table.number_or_none("nodata_value", "a number within float32", -3e38, 3e38)
    if nodata_value is not None:
        values = raster.values.copy()
        values[values == values.dtype.type(nodata_value)] = np.nan
        raster = Raster(values, raster.x0, raster.y0, raster.dx, raster.dy, raster.crs)
    if keys.cell_size is not None:
        raster = resample(raster, keys.cell_size)
    nodata: Literal["wall", "fill"] = (
        "fill" if table.choice("nodata", ("wall", "fill"), "wall") == "fill" else "wall"
    )
    terrain = make_terrain(
        raster,
        name=name,
        crs=crs,
        vertical_datum=keys.vertical_datum,
        nodata=nodata,
        wall_level=table.number_or_none("wall_level", "an elevation in m", -20_000.0, 20_000.0),
    )
    return _raised(terrain, table, folder)


def _projected(raster: Raster, keys: GroundKeys) -> tuple[Raster, str]:
    """The raster in metres, and the name of its system."""
    table, file = keys.table, keys.table.file
    if table.has("reproject"):
        target = table.text("reproject", longest=200)
        if keys.crs is not None and not same_crs(keys.crs, target, f"{file}: [terrain] reproject"):
            raise table.wrong(
                "reproject", f"the system of [case] crs = '{keys.crs}' is allowed, or leave one out"
            )
        if raster.crs is None:
            raise table.wrong("reproject", "it is allowed only where the file names the system it is in")
        raster = reproject(raster, target, keys.cell_size, f"{file}: [terrain] reproject")
        if keys.bounds:
            raster = crop(raster, keys.bounds, table.text("dem"))
        return raster, target
    if raster.crs is not None:
        check_metres(
            raster.crs, f"{file}: [terrain] dem '{table.text('dem')}' with the system", _centre(raster)
        )
    crs = keys.crs or _short_name(raster.crs)
    if crs is None:
        raise CaseError(
            f"{file}: [case] crs is missing and the terrain file names none; an EPSG code, or"
            f" '{LOCAL}', is needed."
        )
    if raster.crs is None or crs == LOCAL:
        check_metres(crs, f"{file}: [case] crs")
    elif not same_crs(crs, raster.crs, f"{file}: [case] crs"):
        raise CaseError(
            f"{file}: [case] crs is '{crs}', but [terrain] dem '{table.text('dem')}' is in"
            f" '{_short_name(raster.crs)}'; the same system is allowed."
        )
    return raster, crs


def _centre(raster: Raster) -> tuple[float, float] | None:
    return centre_of(raster) if is_geographic(raster.crs, "") else None


def _short_name(crs: str | None) -> str | None:
    if crs is None:
        return None
    from pyproj import CRS

    system = CRS.from_user_input(crs)
    code = system.to_epsg()
    return f"EPSG:{code}" if code else str(system.name)


def read_area(table: Table, folder: CaseFolder) -> list[list[Ring]]:
    """Polygons given in place (`polygon`) or by a file (`polygons`).

    Raises:
        CaseError: both or none are given, or one is not valid.
    """
    if table.has("polygon") == table.has("polygons"):
        raise table.wrong("polygons", "either 'polygons' (a file) or 'polygon' (points) is needed")
    if table.has("polygons"):
        return read_polygons(folder.find(table.text("polygons"), f"{table.file}: [[{table.name}]] polygons"))
    try:
        return [[check_ring(table.points("polygon", 3))]]
    except ValueError as error:
        raise table.wrong("polygon", str(error)) from error


def _raised(terrain: Terrain, table: Table, folder: CaseFolder) -> Terrain:
    z_b = terrain.z_b
    for item in table.tables("raise"):
        by = item.real("by", "a height in m from -1000 to 1000", -1000.0, 1000.0)
        inside = cells_inside(read_area(item, folder), terrain.grid)
        if not inside.any():
            raise CaseError(
                f"{item.file}: [[terrain.raise]] number {item.number} covers no cell of the terrain."
            )
        z_b = z_b.copy()
        z_b[inside] += np.float32(by)
    return Terrain(terrain.grid, z_b, terrain.wall, terrain.nodata_count)


def read_roughness(table: Table, folder: CaseFolder, grid: GridGeometry) -> float | NDArray[np.float32]:
    """Manning's n [s m^(-1/3)]: one number, or one for each cell.

    Raises:
        CaseError: nothing is given, or a value is out of range.
    """
    allowed = f"a Manning roughness from 0 to {MANNING_MAX:g} s m^(-1/3)"
    key, row0 = table.text("key", "manning_n"), table.choice("row0", ("south", "north"), "south")
    if table.has("raster"):
        path = folder.find(table.text("raster"), f"{table.file}: [roughness] raster")
        values = read_on_grid(path, table, grid, key, row0, "nearest")
        bad = ~((values >= 0.0) & (values <= MANNING_MAX))
        if bad.any():
            row, col = np.argwhere(bad)[0].tolist()
            raise table.wrong(
                "raster", f"its cell (row {row}, column {col}) holds {values[row, col]:g}; {allowed} is"
            )
    else:
        everywhere = table.real("manning_n", allowed, 0.0, MANNING_MAX)
        if not table.has("zone"):
            return everywhere
        values = np.full(grid.shape, everywhere, np.float32)
    for zone in table.tables("zone"):
        values[cells_inside(read_area(zone, folder), grid)] = zone.real(
            "manning_n", allowed, 0.0, MANNING_MAX
        )
    return values


def read_on_grid(
    path: Path, table: Table, grid: GridGeometry, key: str, row0: str, kind: Literal["nearest", "linear"]
) -> NDArray[np.float32]:
    """A raster file of a case, on the cells of its terrain; NaN where it says nothing.

    Raises:
        TerrainError: the file is not valid.
    """
    raster = read_dem(
        path,
        key=key,
        row0=row0,
        cell_size=grid.dx,
        origin=(grid.x0, grid.y0),
    )
    if raster.crs is not None and not same_crs(grid.crs, raster.crs, f"{table.file}: [{table.name}]"):
        raise TerrainError(
            f"{table.file}: [{table.name}] raster is not in '{grid.crs}', the system of the terrain."
        )
    coarser = grid.dx > 1.5 * raster.dx
    chosen: Literal["nearest", "linear", "average"] = "average" if coarser and kind == "linear" else kind
    return sample(raster, grid.x0, grid.y0, grid.dx, grid.nrows, grid.ncols, chosen).astype(np.float32)
