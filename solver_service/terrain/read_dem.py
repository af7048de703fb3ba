"""One door to all terrain formats: the file's name says the format, its first bytes must agree."""

from __future__ import annotations

from pathlib import Path

from solver_service.errors import TerrainError
from solver_service.terrain.raster import Raster, crop

FORMATS = {
    ".tif": "GeoTIFF",
    ".tiff": "GeoTIFF",
    ".asc": "ESRI ASCII grid",
    ".dem": "USGS DEM",
    ".img": "ERDAS Imagine",
    ".hgt": "SRTM tile",
    ".hgt.zip": "zipped SRTM tile",
    ".slf": "SELAFIN mesh",
    ".slf.gz": "gzipped SELAFIN mesh",
    ".npz": "NumPy archive",
}


def format_of(path: Path) -> str | None:
    """Suffix in `FORMATS` that the name ends with, None where it is none of them."""
    name = path.name.lower()
    return next((suffix for suffix in sorted(FORMATS, key=len, reverse=True) if name.endswith(suffix)), None)


def read_dem(
    path: Path,
    *,
    key: str | None = None,
    row0: str = "south",
    cell_size: float | None = None,
    origin: tuple[float, float] | None = None,
    bounds: tuple[float, float, float, float] | None = None,
) -> Raster:
    """Read a raster of any format that is known.

    Args:
        path: the file.
        key: name of the array in a .npz.
        row0: which edge row 0 of a .npz is.
        cell_size: cell size [m] of a mesh, or of a .npz that names none.
        origin: south-western corner [m] of a .npz that names none.
        bounds: part to keep: xmin, ymin, xmax, ymax in the coordinates of the file; None for all.

    Raises:
        TerrainError: the file is missing, unreadable, or of no known format.
    """
    from solver_service.terrain import read_gdal

    suffix = format_of(path)
    if suffix is None:
        raise TerrainError(
            f"File '{path.name}' is of no known terrain format; {', '.join(FORMATS)} are allowed."
        )
    if not path.is_file():
        raise TerrainError(f"Terrain file '{path.name}' does not exist in {path.parent}.")
    if suffix.startswith(".slf"):
        from solver_service.terrain.read_selafin import read_selafin

        return read_selafin(path, cell_size, bounds)
    if suffix == ".npz":
        from solver_service.terrain.read_npz import read_npz

        if key is None:
            raise TerrainError(f"Archive '{path.name}' needs the key of its array.")
        raster = read_npz(path, key, row0, cell_size, origin)
    elif suffix == ".asc":
        from solver_service.terrain.read_ascii_grid import read_ascii_grid

        raster = read_ascii_grid(path)
    elif suffix.startswith(".hgt"):
        from solver_service.terrain.read_srtm import read_srtm

        raster = read_srtm(path)
    else:
        readers = {
            "GeoTIFF": read_gdal.read_geotiff,
            "USGS DEM": read_gdal.read_usgs_dem,
            "ERDAS Imagine": read_gdal.read_erdas,
        }
        raster = readers[FORMATS[suffix]](path)
    return crop(raster, bounds, path.name) if bounds else raster
