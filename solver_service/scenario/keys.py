"""Every table and key that a case file may have: one list for the reader, the hints and the tests."""

from __future__ import annotations

INFILTRATION = (
    "rate",
    "capacity",
    "rate_initial",
    "rate_final",
    "decay",
    "conductivity",
    "suction",
    "deficit",
)
"""Numbers of the laws of infiltration."""

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
    "roughness": frozenset({"manning_n", "raster", "key", "row0", "classes", "table", "zone"}),
    "roughness.zone": frozenset({"polygons", "polygon", "manning_n"}),
    "initial": frozenset({"depth", "depth_key", "surface", "surface_key", "row0", "level"}),
    "initial.level": frozenset(
        {"level", "depth", "polygons", "polygon", "side_of_line", "connected_to", "everywhere_below"}
    ),
    "boundary": frozenset({"id", "edge", "from", "to", "kind", "level", "discharge", "slope", "series"}),
    "source": frozenset({"id", "at", "radius", "discharge", "series"}),
    "rain": frozenset({"series", "rate", "unit", "interpolation", "key", "row0"}),
    "infiltration": frozenset({"model", *INFILTRATION, "classes", "table", "row0", "zone"}),
    "infiltration.zone": frozenset({"polygons", "polygon", *INFILTRATION}),
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
        "infiltration.zone",
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
}
"""Tables of the case format that this version cannot compute, with what it can."""

BOUNDARY_KINDS = ("wall", "open", "stage", "discharge", "normal_depth")
"""What an edge may do."""
