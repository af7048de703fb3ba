"""From a case file to a `Case`: TOML, checked key by key, with every file it names."""

from __future__ import annotations

import re
import tomllib
from datetime import datetime
from typing import Any, Literal, cast

from protocol import GridGeometry
from protocol.errors import GridError
from solver_service.errors import CaseError, ModelError, TerrainError
from solver_service.numerics import FloodModel, SolverParams
from solver_service.scenario.case import Case
from solver_service.scenario.case_folder import CaseFolder
from solver_service.scenario.ground import read_ground, read_ground_keys, read_roughness
from solver_service.scenario.keys import NOT_YET
from solver_service.scenario.places import gauge_cells, read_demo, read_gauges, read_sections
from solver_service.scenario.table import Table
from solver_service.scenario.water import read_boundaries, read_initial, read_rain, read_sources

NAME = re.compile(r"[A-Za-z0-9_-]{1,64}\Z")
MAX_DURATION = 1e9
MAX_FRAMES = 1_000_000


def read_top(folder: CaseFolder) -> Table:
    """The tables of a case file, known to be known.

    Raises:
        CaseError: the file is no TOML, or has an unknown or not yet supported table.
    """
    file = folder.case_file.name
    try:
        values: dict[str, Any] = tomllib.loads(folder.text())
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        raise CaseError(f"{file}: is no valid TOML: {error}.") from error
    top = Table(file, "", values)
    for name, instead in NOT_YET.items():
        if top.has(name):
            raise CaseError(f"{file}: [{name}] cannot be computed by this version; {instead}.")
    return top


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
    name = about.text("name", longest=64)
    if not NAME.match(name):
        raise about.wrong("name", "1 to 64 letters, digits, '_' and '-' are allowed")
    start_time = _start_time(about)
    run = need(top, "run")
    duration, output_interval = read_times(run)
    keys = read_ground_keys(need(top, "terrain"), about, cell_size)
    roughness = need(top, "roughness")
    try:
        terrain = read_ground(keys, folder)
        initial = top.table("initial")
        manning_n = read_roughness(roughness, folder, terrain.grid)
        initial_h = read_initial(initial or Table(top.file, "initial", {}), folder, terrain)
        sources = read_sources(top.tables("source"), folder, terrain, start_time)
        gauges = read_gauges(top, folder, terrain.grid)
        sections = read_sections(top.tables("section"), terrain.grid)
        model = FloodModel(
            dx=terrain.grid.dx,
            z_b=terrain.z_b,
            manning_n=manning_n,
            boundaries=read_boundaries(top.tables("boundary"), terrain),
            sources=sources,
            rain=read_rain(top.table("rain"), folder, terrain.z_b.shape, start_time),
            blocked=terrain.wall if terrain.wall.any() else None,
        )
        params = _read_params(run, gauge_cells(gauges, sections, terrain.grid))
    except (ModelError, GridError) as error:
        raise CaseError(f"{top.file}: {error}") from error
    except TerrainError as error:
        message = str(error)
        raise TerrainError(message if message.startswith(top.file) else f"{top.file}: {message}") from error
    imagery = None
    if keys.table.has("imagery"):
        imagery = folder.find(keys.table.text("imagery"), f"{top.file}: [terrain] imagery")
    return Case(
        name=name,
        title=about.text("title", name, longest=200),
        description=about.text("description", ""),
        hypothetical=about.flag("hypothetical"),
        source=about.text("source", ""),
        licence=about.text("licence", ""),
        start_time=start_time.isoformat() if start_time else None,
        grid=terrain.grid,
        z_b=terrain.z_b,
        model=model,
        initial_h=initial_h,
        duration=duration,
        output_interval=output_interval,
        params=params,
        gauges=gauges,
        sections=sections,
        nodata_count=terrain.nodata_count,
        imagery=None if folder.temporary else imagery,
        demo=read_demo(top.table("demo"), terrain.grid),
    )


def read_times(run: Table) -> tuple[float, float]:
    """Duration and output interval [s].

    Raises:
        CaseError: one is missing or out of range.
    """
    duration = run.real(
        "duration", f"a time in s above 0, up to {MAX_DURATION:g},", 0.0, MAX_DURATION, above=True
    )
    allowed = (
        f"a time in s above 0, up to the duration of {duration:g}, that makes at most {MAX_FRAMES} frames,"
    )
    interval = run.real("output_interval", allowed, duration / MAX_FRAMES, duration)
    return duration, interval


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


def _read_params(run: Table, gauges: tuple[tuple[float, float], ...]) -> SolverParams:
    default = SolverParams()
    order = run.values.get("order", default.order)
    if order not in (1, 2) or isinstance(order, bool):
        raise run.wrong("order", "1 or 2 is allowed")
    depth_dry = run.real(
        "depth_dry", "a depth in m from 0.000001 to 0.1", 1e-6, 0.1, default=default.depth_dry
    )
    return SolverParams(
        cfl=run.real(
            "cfl", "a Courant number above 0, up to 0.5,", 0.0, 0.5, default=default.cfl, above=True
        ),
        order=cast(Literal[1, 2], order),
        riemann=cast(Literal["hllc", "hll"], run.choice("riemann", ("hllc", "hll"), default.riemann)),
        depth_dry=depth_dry,
        depth_film=min(default.depth_film, depth_dry),
        depth_arrival=run.real(
            "depth_arrival", "a depth in m above 0", 0.0, 10.0, default=default.depth_arrival, above=True
        ),
        gauges=gauges,
        gauge_interval=run.real(
            "gauge_interval",
            "a time in s above 0",
            0.0,
            MAX_DURATION,
            default=default.gauge_interval,
            above=True,
        ),
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
