"""[[weir]], [[culvert]] and [[pump]]: from coordinates and levels to cells and faces."""

from __future__ import annotations

import math
from typing import Literal

from solver_service.errors import CaseError
from solver_service.numerics.structures import Culvert, Pump, Weir
from solver_service.scenario.csv_file import read_csv
from solver_service.scenario.inputs import Inputs
from solver_service.scenario.quantities import DISCHARGE, LEVEL
from solver_service.scenario.table import Table

LEVEL_WORDS = "an elevation in m"
ROUND = math.pi / 4.0
"""A pipe of diameter D counts as a box of height D and width pi D / 4."""


def read_weirs(tables: list[Table], inputs: Inputs) -> tuple[Weir, ...]:
    """Walls and levees thinner than a cell.

    Raises:
        CaseError: a key is not valid.
    """
    weirs = []
    for number, table in enumerate(tables, start=1):
        line = table.points("line", 2)
        crest = table.values.get("crest")
        levels = table.numbers("crest", len(line)) if isinstance(crest, list) else (_level(table, "crest"),)
        for level in levels:
            _check_near_ground(table, "crest", level, inputs)
        weirs.append(
            Weir(
                id=table.text("id", f"weir-{number}", longest=64),
                vertices=inputs.line(table, "line"),
                crest=tuple(level - inputs.grid.datum_offset for level in levels),
                coefficient=table.real(
                    "coefficient", "a number from 0.1 to 4 m^0.5/s", 0.1, 4.0, default=1.7
                ),
            )
        )
    return tuple(weirs)


def read_culverts(tables: list[Table], inputs: Inputs) -> tuple[Culvert, ...]:
    """Pipes and boxes under roads and levees.

    Raises:
        CaseError: a key is not valid, or both ends stand in one cell.
    """
    culverts = []
    for number, table in enumerate(tables, start=1):
        width, height = _opening(table)
        (xa, ya), (xb, yb) = table.point("inlet"), table.point("outlet")
        inlet, outlet = _ends(table, inputs)
        between = math.hypot(xb - xa, yb - ya)
        inverts = []
        for end, (row, col) in (("inlet", inlet[0]), ("outlet", outlet[0])):
            key = f"{end}_level"
            ground = float(inputs.terrain.z_b[row, col])
            if not table.has(key):
                inverts.append(ground)
                continue
            level = _level(table, key)
            _check_near_ground(table, key, level, inputs)
            inverts.append(level - inputs.grid.datum_offset)
        barrels = table.real("barrels", "a whole number from 1 to 100", 1, 100, default=1.0)
        if barrels != round(barrels):
            raise table.wrong("barrels", "a whole number from 1 to 100 is allowed")
        culverts.append(
            Culvert(
                id=table.text("id", f"culvert-{number}", longest=64),
                inlet=inlet,
                outlet=outlet,
                invert_inlet=inverts[0],
                invert_outlet=inverts[1],
                width=width,
                height=height,
                length=table.real(
                    "length", "a length in m above 0, up to 10000,", 0.0, 1e4, default=between, above=True
                ),
                barrels=round(barrels),
                manning_n=table.real(
                    "manning_n", "a Manning roughness from 0 to 0.2", 0.0, 0.2, default=0.013
                ),
                entrance_loss=table.real("entrance_loss", "a number from 0 to 10", 0.0, 10.0, default=0.5),
                both_ways=table.flag("both_ways", True),
            )
        )
    return tuple(culverts)


def _opening(table: Table) -> tuple[float, float]:
    """Width and height of a barrel [m]."""
    given = [key for key in ("diameter", "width", "height") if table.has(key)]
    if given not in (["diameter"], ["width", "height"]):
        raise CaseError(
            f"{table.file}: {table.label} has {' and '.join(given) or 'no opening'}; either diameter, or"
            " width and height, in m are allowed."
        )
    if given == ["diameter"]:
        diameter = table.real("diameter", "a diameter in m above 0, up to 50,", 0.0, 50.0, above=True)
        return ROUND * diameter, diameter
    width = table.real("width", "a width in m above 0, up to 100,", 0.0, 100.0, above=True)
    return width, table.real("height", "a height in m above 0, up to 50,", 0.0, 50.0, above=True)


def read_pumps(tables: list[Table], inputs: Inputs) -> tuple[Pump, ...]:
    """Pumps between two places, or out of the terrain.

    Raises:
        CaseError: a key or a rating is not valid, or both ends stand in one cell.
    """
    offset = inputs.grid.datum_offset
    pumps = []
    for number, table in enumerate(tables, start=1):
        inlet, outlet = _ends(table, inputs)
        against, levels, discharge = _rating(table, inputs)
        if against == "head" and not outlet:
            raise table.wrong("rating", "a pump without outlet needs a rating against 'level'")
        switch = []
        for key in ("start_level", "stop_level"):
            level = _level(table, key) if table.has(key) else None
            if level is not None:
                _check_near_ground(table, key, level, inputs)
            switch.append(None if level is None else level - offset)
        pumps.append(
            Pump(
                id=table.text("id", f"pump-{number}", longest=64),
                inlet=inlet,
                outlet=outlet or None,
                rating=tuple(level - offset if against == "level" else level for level in levels),
                discharge=tuple(discharge),
                rating_against=against,
                start_level=switch[0],
                stop_level=switch[1],
            )
        )
    return tuple(pumps)


def _rating(table: Table, inputs: Inputs) -> tuple[Literal["level", "head"], list[float], list[float]]:
    """What the discharge [m3/s] depends on, its values [m], and the discharge at each."""
    if table.has("discharge") == table.has("rating"):
        raise table.wrong("discharge", "either 'discharge' in m3/s or 'rating' (a CSV file) is needed")
    if table.has("discharge"):
        allowed = "a discharge in m3/s from 0 to 10000"
        return "level", [inputs.grid.datum_offset], [table.real("discharge", allowed, 0.0, 1e4)]
    path = inputs.file(table, "rating")
    columns, lines = read_csv(path)
    if columns not in (["level", "discharge"], ["head", "discharge"]):
        raise CaseError(
            f"{path.name}: line 1 is '{','.join(columns)[:80]}'; 'level,discharge' or 'head,discharge' in m"
            " and m3/s is allowed."
        )
    if not lines:
        raise CaseError(f"{path.name}: has no line of values.")
    levels: list[float] = []
    for line in lines:
        level = line.real(columns[0], LEVEL.low, LEVEL.high)
        if levels and level <= levels[-1]:
            raise line.wrong(f"is at {level:g} m, not above {levels[-1]:g} m; increasing values are allowed")
        levels.append(level)
    against: Literal["level", "head"] = "head" if columns[0] == "head" else "level"
    return against, levels, [line.real("discharge", DISCHARGE.low, 1e4) for line in lines]


Cells = tuple[tuple[int, int], ...]


def _ends(table: Table, inputs: Inputs) -> tuple[Cells, Cells]:
    """Cells of inlet and outlet; no cells where no outlet is given."""
    radius = table.real("radius", "a radius in m at or above 0", 0.0, 1e4, default=0.0)
    inlet = inputs.disc(table, "inlet", radius)
    outlet = inputs.disc(table, "outlet", radius) if table.has("outlet") else ()
    both = set(inlet) & set(outlet)
    if both:
        row, col = min(both)
        raise table.wrong(
            "outlet", f"its cell (row {row}, column {col}) is one of the inlet too; other cells are allowed"
        )
    return inlet, outlet


def _level(table: Table, key: str) -> float:
    return table.real(key, LEVEL_WORDS, LEVEL.low, LEVEL.high)


def _check_near_ground(table: Table, key: str, level: float, inputs: Inputs) -> None:
    """Refuse a level [m] far from all ground: it was measured in another unit or from another datum."""
    z = inputs.terrain.z_b[~inputs.terrain.wall]
    low, high = (float(limit) + inputs.grid.datum_offset for limit in (z.min(), z.max()))
    if not low - 1000.0 <= level <= high + 1000.0:
        raise table.wrong(
            key,
            f"the ground reaches from {low:.2f} to {high:.2f} m; a level within 1000 m of it is allowed, so"
            " check unit and vertical datum",
        )
