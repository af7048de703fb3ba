"""From a case file to a `Case`: TOML, checked key by key, with every file it names."""

from __future__ import annotations

import re
import tomllib
from datetime import datetime
from typing import Any

from protocol import GridGeometry
from protocol.errors import GridError
from solver_service.errors import CaseError, ModelError, TerrainError
from solver_service.numerics import FloodModel
from solver_service.scenario.boundaries import read_boundaries
from solver_service.scenario.breaches import read_breaches
from solver_service.scenario.case import Case
from solver_service.scenario.case_folder import CaseFolder
from solver_service.scenario.demo import read_demo
from solver_service.scenario.ground import GroundKeys, read_ground, read_ground_keys
from solver_service.scenario.infiltration import read_infiltration
from solver_service.scenario.initial import read_initial
from solver_service.scenario.inputs import Inputs
from solver_service.scenario.places import gauge_cells, read_gauges, read_sections, structure_sections
from solver_service.scenario.rain import read_rain
from solver_service.scenario.roughness import read_roughness
from solver_service.scenario.run_settings import read_params, read_times
from solver_service.scenario.sources import read_sources
from solver_service.scenario.structures import read_culverts, read_pumps, read_weirs
from solver_service.scenario.table import Table

NAME = re.compile(r"[A-Za-z0-9_-]{1,64}\Z")


def read_top(folder: CaseFolder) -> Table:
    """The tables of a case file, known to be known.

    Raises:
        CaseError: the file is no TOML, or has an unknown table.
    """
    file = folder.case_file.name
    try:
        values: dict[str, Any] = tomllib.loads(folder.text())
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        raise CaseError(f"{file}: is no valid TOML: {error}.") from error
    return Table(file, "", values)


def need(top: Table, name: str) -> Table:
    """A table that must be there.

    Raises:
        CaseError: it is missing.
    """
    table = top.table(name)
    if table is None:
        raise CaseError(f"{top.file}: the table [{name}] is missing.")
    return table


def read_case(folder: CaseFolder, cell_size: float | None = None) -> Case:
    """Read a case and every file it names.

    Args:
        folder: the case file and the folder of its files.
        cell_size: cell size to use instead of the case's [m].

    Raises:
        CaseError: the case is not valid: file, table, key, value and what is allowed.
        TerrainError: a terrain file is not valid.
    """
    top = read_top(folder)
    about = need(top, "case")
    if not NAME.match(about.text("name", longest=64)):
        raise about.wrong("name", "1 to 64 letters, digits, '_' and '-' are allowed")
    start_time = _start_time(about)
    run = need(top, "run")
    duration, _ = read_times(run)
    keys = read_ground_keys(need(top, "terrain"), about, cell_size)
    need(top, "roughness")
    try:
        inputs = Inputs(folder, read_ground(keys, folder), start_time, duration)
        return _read_below_ground(top, keys, inputs)
    except (ModelError, GridError) as error:
        raise CaseError(f"{top.file}: {error}") from error
    except TerrainError as error:
        message = str(error)
        raise TerrainError(message if message.startswith(top.file) else f"{top.file}: {message}") from error


def _read_below_ground(top: Table, keys: GroundKeys, inputs: Inputs) -> Case:
    """Everything that lies on the ground, and the case that it makes."""
    about, run, terrain, folder = need(top, "case"), need(top, "run"), inputs.terrain, inputs.folder
    duration, output_interval = read_times(run)
    gauges = read_gauges(top, folder, terrain.grid)
    sections = read_sections(top.tables("section"), inputs)
    model = FloodModel(
        dx=terrain.grid.dx,
        z_b=terrain.z_b,
        manning_n=read_roughness(need(top, "roughness"), inputs),
        boundaries=read_boundaries(top.tables("boundary"), inputs),
        sources=read_sources(top.tables("source"), inputs),
        rain=read_rain(top.table("rain"), inputs),
        infiltration=read_infiltration(top.table("infiltration"), inputs),
        structures=(
            *read_weirs(top.tables("weir"), inputs),
            *read_culverts(top.tables("culvert"), inputs),
            *read_pumps(top.tables("pump"), inputs),
        ),
        breaches=read_breaches(top.tables("breach"), inputs),
        blocked=terrain.wall if terrain.wall.any() else None,
    )
    check_ids(model, top.file)
    imagery = inputs.file(keys.table, "imagery") if keys.table.has("imagery") else None
    return Case(
        name=about.text("name"),
        title=about.text("title", about.text("name"), longest=200),
        description=about.text("description", ""),
        hypothetical=about.flag("hypothetical"),
        source=about.text("source", ""),
        licence=about.text("licence", ""),
        start_time=inputs.start_time.isoformat() if inputs.start_time else None,
        grid=terrain.grid,
        z_b=terrain.z_b,
        model=model,
        initial_h=read_initial(top.table("initial") or Table(top.file, "initial", {}), inputs),
        duration=duration,
        output_interval=output_interval,
        params=read_params(run, gauge_cells(gauges, terrain.grid), (*sections, *structure_sections(model))),
        gauges=gauges,
        sections=sections,
        nodata_count=terrain.nodata_count,
        warnings=tuple(inputs.warnings),
        imagery=None if folder.temporary else imagery,
        demo=read_demo(top.table("demo"), terrain.grid),
    )


def check_ids(model: FloodModel, file: str) -> None:
    """Refuse a name that two boundaries, sources, structures or breaches share, for the budget goes by name.

    Raises:
        CaseError: naming it.
    """
    named: dict[str, str] = {}
    kinds = (
        ("boundary", model.boundaries),
        ("source", model.sources),
        ("structure", model.structures),
        ("breach", model.breaches),
    )
    for kind, parts in kinds:
        for part in parts:
            if not part.id or part.id in named:
                also = f", and of a {named[part.id]}" if part.id in named else ""
                raise CaseError(f"{file}: '{part.id}' is the id of a {kind}{also}; each its own is allowed.")
            named[part.id] = kind


def planned_grid(folder: CaseFolder) -> GridGeometry | None:
    """The grid of a case that says its bounds and cell size, without reading its terrain; None otherwise."""
    top = read_top(folder)
    about, terrain = need(top, "case"), need(top, "terrain")
    keys = read_ground_keys(terrain, about, None)
    if keys.bounds is None or keys.cell_size is None:
        return None
    xmin, ymin, xmax, ymax = keys.bounds
    return GridGeometry(
        nrows=round((ymax - ymin) / keys.cell_size),
        ncols=round((xmax - xmin) / keys.cell_size),
        dx=keys.cell_size,
        x0=xmin,
        y0=ymin,
    )


def _start_time(about: Table) -> datetime | None:
    if not about.has("start_time"):
        return None
    value = about.values["start_time"]
    try:
        moment = value if isinstance(value, datetime) else datetime.fromisoformat(str(value))
    except ValueError:
        moment = None
    if moment is None or moment.tzinfo is None:
        raise about.wrong(
            "start_time", "an ISO-8601 time with an offset, like '1959-12-02T21:14:00+01:00', is allowed"
        )
    return moment
