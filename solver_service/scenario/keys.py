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
    "weir": frozenset({"id", "line", "crest", "coefficient"}),
    "culvert": frozenset(
        {
            "id",
            "inlet",
            "outlet",
            "radius",
            "inlet_level",
            "outlet_level",
            "diameter",
            "width",
            "height",
            "length",
            "barrels",
            "manning_n",
            "entrance_loss",
            "both_ways",
        }
    ),
    "pump": frozenset(
        {"id", "inlet", "outlet", "radius", "discharge", "rating", "start_level", "stop_level"}
    ),
    "breach": frozenset(
        {
            "id",
            "line",
            "law",
            "start",
            "start_time",
            "duration",
            "crest",
            "bottom_level",
            "width_initial",
            "width_final",
            "across",
            "side_slope",
            "f1",
            "f2",
            "critical_velocity",
        }
    ),
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
            "depth_film",
            "depth_cfl",
            "eddy_viscosity",
            "depth_arrival",
            "arrival_depths",
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
        "weir",
        "culvert",
        "pump",
        "breach",
        "gauge",
        "section",
        "demo.edit",
    }
)
"""Tables that may stand several times: [[name]]."""

BOUNDARY_KINDS = ("wall", "open", "stage", "discharge", "normal_depth")
"""What an edge may do."""
