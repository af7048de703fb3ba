"""[[breach]]: openings that grow in levees and dams."""

from __future__ import annotations

import itertools
import math
from typing import Literal

import numpy as np

from protocol.limits import MAX_BED_CELLS
from solver_service.numerics.breach import Breach
from solver_service.numerics.snapping import face_chain
from solver_service.scenario.inputs import Inputs
from solver_service.scenario.quantities import LEVEL
from solver_service.scenario.table import Table

LAWS = ("linear", "verheij_van_der_knaap")
LAW_KEYS = ("f1", "f2", "critical_velocity")


def read_breaches(tables: list[Table], inputs: Inputs) -> tuple[Breach, ...]:
    """Breaches in their order, each with an id.

    Raises:
        CaseError: a key is not valid, the bottom lies above the crest, two breaches share a cell, or all
            together may eat more cells than a frame can tell.
    """
    breaches: list[Breach] = []
    taken: dict[tuple[int, int], int] = {}
    for number, table in enumerate(tables, start=1):
        breach = _read(table, number, inputs)
        for row, col in breach.snapped(inputs.grid.shape, inputs.grid.dx).cells.tolist():
            other = taken.setdefault((row, col), number)
            if other != number:
                raise table.wrong(
                    "line",
                    f"it may eat cell (row {row}, column {col}), as number {other} may; lines further apart,"
                    " or a smaller width_final or across, are allowed",
                )
        if len(taken) > MAX_BED_CELLS:
            raise table.wrong(
                "line",
                f"with those before it {len(taken)} cells may be eaten; up to {MAX_BED_CELLS} in all are"
                " allowed",
            )
        breaches.append(breach)
    return tuple(breaches)


def _read(table: Table, number: int, inputs: Inputs) -> Breach:
    offset = inputs.grid.datum_offset
    law: Literal["linear", "verheij_van_der_knaap"] = (
        "linear" if table.choice("law", LAWS, "linear") == "linear" else "verheij_van_der_knaap"
    )
    start: Literal["time", "overtopping"] = (
        "time" if table.choice("start", ("time", "overtopping"), "time") == "time" else "overtopping"
    )
    for key in LAW_KEYS:
        if table.has(key) and law == "linear":
            raise table.wrong(key, "it is allowed where law = 'verheij_van_der_knaap'")
    if law == "linear" and not table.has("width_final"):
        raise table.wrong("width_final", "a width in m is needed where law = 'linear'")
    points = table.points("line", 2)
    length = sum(math.dist(a, b) for a, b in itertools.pairwise(points))
    vertices = inputs.line(table, "line")
    if not len(face_chain(vertices, inputs.grid.shape)):
        raise table.wrong("line", f"a line of at least one cell ({inputs.grid.dx:g} m) is allowed")
    ground = _highest_ground(vertices, inputs)
    crest = table.real("crest", "an elevation in m", LEVEL.low, LEVEL.high, default=ground)
    if abs(crest - ground) > 1000.0:
        raise table.wrong(
            "crest", f"the highest ground of its line is at {ground:.2f} m; a level within 1000 m is allowed"
        )
    bottom = table.real("bottom_level", "an elevation in m", LEVEL.low, LEVEL.high)
    if bottom >= crest:
        raise table.wrong(
            "bottom_level",
            f"the crest{'' if table.has('crest') else ', the highest ground of its line,'} is at"
            f" {crest:.2f} m; a level below it is allowed",
        )
    widest = f"a width in m above 0, up to the length of its line ({length:.6g} m),"
    final = None
    if table.has("width_final"):
        final = table.real("width_final", widest, 0.0, length, above=True)
    first = table.real(
        "width_initial", "a width in m from 0 to the final width", 0.0, length if final is None else final,
        default=0.0 if law == "linear" else min(inputs.grid.dx, length),
    )  # fmt: skip
    start_time = table.real("start_time", "a time in s at or above 0", 0.0, 1e9, default=0.0)
    if start_time > inputs.duration:
        inputs.warnings.append(
            f"{table.label} starts at {start_time:g} s, after the end of the run at {inputs.duration:g} s."
        )
    return Breach(
        id=table.text("id", f"breach-{number}", longest=64),
        vertices=vertices,
        crest=crest - offset,
        bottom_level=bottom - offset,
        duration=table.real("duration", "a time in s above 0", 0.0, 1e9, above=True),
        width_initial=first,
        width_final=final,
        across=table.real("across", "a width in m from 0 to 10000", 0.0, 1e4, default=0.0),
        side_slope=table.real("side_slope", "a number from 0 to 20", 0.0, 20.0, default=0.0),
        start=start,
        start_time=start_time,
        law=law,
        f1=table.real("f1", "a number above 0, up to 10,", 0.0, 10.0, default=1.3, above=True),
        f2=table.real("f2", "a number above 0, up to 10,", 0.0, 10.0, default=0.04, above=True),
        critical_velocity=table.real(
            "critical_velocity", "a velocity in m/s from 0.01 to 10", 0.01, 10.0, default=0.2
        ),
    )


def _highest_ground(vertices: tuple[tuple[float, float], ...], inputs: Inputs) -> float:
    """Highest bed [m] of the cells nearest to points every half cell along a line."""
    highest = -math.inf
    z = inputs.terrain.z_b
    for (xa, ya), (xb, yb) in itertools.pairwise(vertices):
        t = np.linspace(0.0, 1.0, 2 + math.ceil(2.0 * math.hypot(xb - xa, yb - ya)))
        cols = np.clip(np.rint(xa + t * (xb - xa)).astype(int), 0, z.shape[1] - 1)
        rows = np.clip(np.rint(ya + t * (yb - ya)).astype(int), 0, z.shape[0] - 1)
        highest = max(highest, float(z[rows, cols].max()))
    return highest + inputs.grid.datum_offset
