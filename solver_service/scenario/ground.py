"""[terrain] and [[terrain.raise]]: the ground of a case."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from solver_service.errors import CaseError
from solver_service.scenario.case_folder import CaseFolder
from solver_service.scenario.inputs import covered_cells
from solver_service.scenario.table import Table
from solver_service.terrain import (
    LOCAL,
    Raster,
    Terrain,
    centre_of,
    check_metres,
    crop,
    is_geographic,
    make_terrain,
    read_dem,
    reproject,
    resample,
    same_crs,
)


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


def _raised(terrain: Terrain, table: Table, folder: CaseFolder) -> Terrain:
    z_b = terrain.z_b
    for item in table.tables("raise"):
        by = item.real("by", "a height in m from -1000 to 1000", -1000.0, 1000.0)
        inside = covered_cells(item, folder, terrain.grid)
        z_b = z_b.copy()
        z_b[inside] += np.float32(by)
    return Terrain(terrain.grid, z_b, terrain.wall, terrain.nodata_count)
