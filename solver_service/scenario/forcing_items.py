"""What drives the flood of a case from outside, as viewers are told of it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from protocol import ForcingItem, limits
from protocol.forcing import ForcingKind, ForcingUnit, thinned
from solver_service.numerics import EdgeBoundary, FloodModel
from solver_service.scenario.boundaries import DISCHARGE_PER_WIDTH_MAX
from solver_service.scenario.case import Case
from solver_service.scenario.initial import FAR_ABOVE
from solver_service.scenario.quantities import DISCHARGE, LEVEL, RAIN

RAIN_ID = "rain"
UNITS: dict[ForcingKind, ForcingUnit] = {
    "source": "m3/s",
    "discharge": "m3/s",
    "stage": "m",
    "rain": "mm/h",
    "breach": "s",
}


@dataclass(frozen=True)
class Place:
    """Where an item stands in a model.

    Attributes:
        id: id of the item, unique in the model.
        kind: what it is.
        number: its place among the sources, boundaries or breaches of the model.
    """

    id: str
    kind: ForcingKind
    number: int


def places(model: FloodModel) -> tuple[Place, ...]:
    """The items of a model in their order; one whose name another one has goes by kind and name.

    There is always rain, though it may be none.
    """
    found: list[Place] = []
    taken: set[str] = set()

    def add(kind: ForcingKind, name: str, number: int) -> None:
        unique = name if name not in taken and (name != RAIN_ID or kind == "rain") else f"{kind} {name}"
        while unique in taken:
            unique = f"{unique} {number + 1}"
        taken.add(unique)
        found.append(Place(unique, kind, number))

    for number, source in enumerate(model.sources):
        add("source", source.id or f"source-{number + 1}", number)
    for number, boundary in enumerate(model.boundaries):
        if boundary.kind in ("stage", "discharge"):
            kind: ForcingKind = "stage" if boundary.kind == "stage" else "discharge"
            add(kind, boundary.id or f"{boundary.edge}-{number + 1}", number)
    add("rain", RAIN_ID, 0)
    for number, breach in enumerate(model.breaches):
        add("breach", breach.id, number)
    return tuple(found[: limits.MAX_FORCING_ITEMS])


def forcing_items(case: Case) -> tuple[ForcingItem, ...]:
    """What viewers are told of the forcing of a case."""
    return tuple(_item(place, case) for place in places(case.model))


def _item(place: Place, case: Case) -> ForcingItem:
    model, offset = case.model, case.grid.datum_offset
    unit = UNITS[place.kind]
    if place.kind == "source":
        source = model.sources[place.number]
        rim = 2.0 * math.sqrt(math.pi * source.rows.size) * model.dx
        high = min(DISCHARGE.high, DISCHARGE_PER_WIDTH_MAX * rim)
        return ForcingItem(
            place.id, place.kind, unit, 0.0, high, thinned(source.times.tolist(), source.discharge.tolist())
        )
    if place.kind == "breach":
        breach = model.breaches[place.number]
        return ForcingItem(
            place.id,
            place.kind,
            unit,
            start_time=breach.start_time,
            overtopping=breach.start == "overtopping",
        )
    if place.kind == "rain":
        if model.rain is None:
            return ForcingItem(place.id, place.kind, unit, RAIN.low, RAIN.high)
        largest = model.rain.rates.max(axis=(1, 2)) / RAIN.units[unit]
        shown = thinned(model.rain.times.tolist(), largest.tolist())
        return ForcingItem(place.id, place.kind, unit, RAIN.low, RAIN.high, shown)
    boundary = model.boundaries[place.number]
    times, values = series_of(boundary)
    if place.kind == "stage":
        ground = float(case.z_b.max()) if model.blocked is None else float(case.z_b[~model.blocked].max())
        high = min(LEVEL.high, ground + offset + FAR_ABOVE)
        shown = thinned(times.tolist(), (values + offset).tolist())
        return ForcingItem(place.id, place.kind, unit, LEVEL.low, high, shown)
    high = min(DISCHARGE.high, DISCHARGE_PER_WIDTH_MAX * (boundary.last - boundary.first) * model.dx)
    return ForcingItem(place.id, place.kind, unit, -high, high, thinned(times.tolist(), values.tolist()))


def series_of(boundary: EdgeBoundary) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Times [s] and values of a boundary that has a series."""
    assert boundary.times is not None
    assert boundary.values is not None
    return boundary.times, boundary.values
