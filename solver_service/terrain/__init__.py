"""Terrain files of many formats, turned into one kind of grid."""

from solver_service.terrain.polygons import Ring, cells_inside, check_ring, read_polygons
from solver_service.terrain.projection import (
    LOCAL,
    centre_of,
    check_metres,
    is_geographic,
    reproject,
    same_crs,
    utm_zone,
)
from solver_service.terrain.raster import BROKEN_ARCHIVE, Raster, crop
from solver_service.terrain.read_dem import FORMATS, format_of, read_dem
from solver_service.terrain.read_gdal import read_geotiff
from solver_service.terrain.resample import resample, sample
from solver_service.terrain.terrain import Terrain, datum_offset, make_terrain

__all__ = [
    "BROKEN_ARCHIVE",
    "FORMATS",
    "LOCAL",
    "Raster",
    "Ring",
    "Terrain",
    "cells_inside",
    "centre_of",
    "check_metres",
    "check_ring",
    "crop",
    "datum_offset",
    "format_of",
    "is_geographic",
    "make_terrain",
    "read_dem",
    "read_geotiff",
    "read_polygons",
    "reproject",
    "resample",
    "same_crs",
    "sample",
    "utm_zone",
]
