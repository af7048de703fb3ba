"""[run]: how long, how often, and how the scheme is tuned."""

from __future__ import annotations

import itertools
from typing import Literal, cast

from solver_service.numerics import SolverParams
from solver_service.numerics.section import Section
from solver_service.scenario.table import Table

MAX_DURATION = 1e9
MAX_FRAMES = 1_000_000
MAX_CLASSES = 8
"""Depth classes; each costs 4 bytes a cell."""


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


def read_params(
    run: Table, gauges: tuple[tuple[float, float], ...], sections: tuple[Section, ...]
) -> SolverParams:
    """The tuning of the solver, with the places that it records.

    Raises:
        CaseError: a key is out of range.
    """
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
        depth_film=run.real(
            "depth_film",
            f"a depth in m from 0.00000001 to depth_dry ({depth_dry:g})",
            1e-8,
            depth_dry,
            default=min(default.depth_film, depth_dry),
        ),
        arrival_depths=_arrival_depths(run),
        depth_arrival=run.real(
            "depth_arrival", "a depth in m above 0", 0.0, 10.0, default=default.depth_arrival, above=True
        ),
        depth_cfl=run.real("depth_cfl", "a depth in m from 0 to 0.05", 0.0, 0.05, default=default.depth_cfl),
        eddy_viscosity=run.real(
            "eddy_viscosity", "a number from 0 to 100", 0.0, 100.0, default=default.eddy_viscosity
        ),
        gauges=gauges,
        sections=sections,
        gauge_interval=run.real(
            "gauge_interval",
            "a time in s above 0",
            0.0,
            MAX_DURATION,
            default=default.gauge_interval,
            above=True,
        ),
    )


def _arrival_depths(run: Table) -> tuple[float, ...]:
    """Depth classes [m] whose arrival times are kept."""
    if not run.has("arrival_depths"):
        return ()
    given = run.values["arrival_depths"]
    count = len(given) if isinstance(given, list) else 0
    depths = run.numbers("arrival_depths", count) if 0 < count <= MAX_CLASSES else ()
    if not depths or depths[0] <= 0.0 or any(a >= b for a, b in itertools.pairwise(depths)):
        raise run.wrong(
            "arrival_depths", f"1 to {MAX_CLASSES} depths in m above 0, each above the last, are allowed"
        )
    return depths
