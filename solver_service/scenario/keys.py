"""Every table and key that a case file may have: one list for the reader, the hints and the tests."""

from __future__ import annotations

KEYS: dict[str, frozenset[str]] = {
    "": frozenset({"gauges"}),
    "case": frozenset(
        {
            "name",
            "title",
            "description",
            "crs",
            "vertical_datum",
            "source",
            "licence",
            "hypothetical",
            "start_time",
        }
    ),
    "terrain": frozenset(
        {
            "dem",
            "key",
            "row0",
            "cell_size",
            "origin",
            "bounds",
            "nodata",
            "nodata_value",
            "wall_level",
            "reproject",
            "imagery",
            "raise",
        }
    ),
    "terrain.raise": frozenset({"polygons", "polygon", "by"}),
    "roughness": frozenset({"manning_n", "raster", "key", "row0", "zone"}),
    "roughness.zone": frozenset({"polygons", "polygon", "manning_n"}),
    "initial": frozenset({"depth", "depth_key", "row0", "level"}),
    "initial.level": frozenset({"level", "polygon", "side_of_line", "connected_to", "everywhere_below"}),
    "boundary": frozenset({"edge", "from", "to", "kind"}),
    "source": frozenset({"at", "radius", "discharge", "series"}),
    "rain": frozenset({"series", "rate"}),
    "gauge": frozenset({"id", "at"}),
    "section": frozenset({"id", "line"}),
    "run": frozenset(
        {
            "duration",
            "output_interval",
            "gauge_interval",
            "cfl",
            "order",
            "riemann",
            "depth_dry",
            "depth_arrival",
        }
    ),
    "demo": frozenset({"time", "target", "edit"}),
    "demo.edit": frozenset({"line", "width", "operation", "type", "magnitude", "level"}),
}
"""Allowed keys of each table; arrays of tables are named without their brackets."""

ARRAYS = frozenset(
    {
        "terrain.raise",
        "roughness.zone",
        "initial.level",
        "boundary",
        "source",
        "gauge",
        "section",
        "demo.edit",
    }
)
"""Tables that may stand several times: [[name]]."""

NOT_YET: dict[str, str] = {
    "breach": "the supported ways of water are [initial], [[source]], [rain] and open edges",
    "infiltration": "the supported ways of water are [initial], [[source]], [rain] and open edges",
}
"""Tables of the case format that this version cannot compute, with what it can."""

BOUNDARY_KINDS = ("wall", "open")
BOUNDARY_KINDS_NOT_YET = ("stage", "discharge", "normal_depth")
"""Kinds of the case format that this version cannot compute."""
