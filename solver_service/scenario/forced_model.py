"""The model of a run whose forcing differs from its case from some time on.

A model is that of the lineage: what held before a change holds up to its time, so that the integrals that
the books of a run rest on stay true, and a run can be restored at any time of its own.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from protocol import ForcingChange, ForcingSeries
from solver_service.numerics import Breach, EdgeBoundary, FloodModel, Rain, Source
from solver_service.numerics.joined_series import SeriesArrays, join_series
from solver_service.scenario.case import Case
from solver_service.scenario.forcing_items import Place, places, series_of
from solver_service.scenario.quantities import RAIN

NEVER = 1.0e12
"""Beginning of a breach that never comes [s]."""

Changes = tuple[ForcingChange, ...]


@dataclass(frozen=True)
class ForcedFrom:
    """A stretch of time with its own changes to the case.

    Attributes:
        time: where it begins [s].
        changes: how the forcing differs from the case.
    """

    time: float
    changes: Changes


def stretches(course: tuple[ForcedFrom, ...]) -> tuple[ForcedFrom, ...]:
    """Those of a course that change something: none for a run that is driven as its case says."""
    found: list[ForcedFrom] = []
    held: dict[str, ForcingChange] = {}
    for stretch in course:
        wanted = _by_item(stretch.changes)
        if wanted != held:
            found.append(stretch)
            held = wanted
    return tuple(found)


def forced_model(case: Case, course: tuple[ForcedFrom, ...]) -> FloodModel:
    """The model of a case under changes that hold one after the other.

    Args:
        case: the case.
        course: from when on which changes hold, in order of time; before the first the case does.

    Raises:
        ModelError: a changed series is not valid.
    """
    model = case.model
    held: dict[str, ForcingChange] = {}
    for stretch in course:
        wanted = _by_item(stretch.changes)
        for place in places(case.model):
            if wanted.get(place.id) != held.get(place.id):
                change = wanted.get(place.id, ForcingChange(place.id))
                model = _changed(model, case, place, change, stretch.time)
        held = wanted
    return model


def _by_item(changes: Changes) -> dict[str, ForcingChange]:
    return {change.id: change for change in changes if not change.is_neutral}


def _changed(model: FloodModel, case: Case, place: Place, change: ForcingChange, time: float) -> FloodModel:
    number = place.number
    if place.kind == "source":
        sources = list(model.sources)
        sources[number] = _source(sources[number], case.model.sources[number], change, time)
        return replace(model, sources=tuple(sources))
    if place.kind == "breach":
        breaches = list(model.breaches)
        breaches[number] = _breach(breaches[number], case.model.breaches[number], change, time)
        return replace(model, breaches=tuple(breaches))
    if place.kind == "rain":
        return replace(model, rain=_rain(model, case.model.rain, change, time))
    boundaries = list(model.boundaries)
    shift = case.grid.datum_offset if place.kind == "stage" else 0.0
    boundaries[number] = _boundary(boundaries[number], case.model.boundaries[number], change, time, shift)
    return replace(model, boundaries=tuple(boundaries))


def _source(held: Source, base: Source, change: ForcingChange, time: float) -> Source:
    own = SeriesArrays(base.times, base.discharge)
    wanted = own if change.series is None else _arrays(change.series)
    wanted = SeriesArrays(wanted.times, change.factor * wanted.values)
    times, discharge = _from(time, SeriesArrays(held.times, held.discharge), wanted)
    return replace(held, times=times, discharge=discharge)


def _boundary(
    held: EdgeBoundary, base: EdgeBoundary, change: ForcingChange, time: float, shift: float
) -> EdgeBoundary:
    wanted = SeriesArrays(*series_of(base))
    if change.series is not None:
        wanted = _arrays(change.series)
        wanted = SeriesArrays(wanted.times, wanted.values - shift)
    wanted = SeriesArrays(wanted.times, change.factor * wanted.values + change.offset)
    times, values = _from(time, SeriesArrays(*series_of(held)), wanted, holds_first=True)
    return replace(held, times=times, values=values)


def _rain(model: FloodModel, base: Rain | None, change: ForcingChange, time: float) -> Rain:
    nothing = Rain.uniform([0.0], [0.0], model.shape)
    held, base = model.rain or nothing, base or nothing
    wanted = SeriesArrays(base.times, base.rates)
    if change.series is not None:
        given = _arrays(change.series)
        rates = given.values[:, None, None] * RAIN.units["mm/h"]
        wanted = SeriesArrays(given.times, np.broadcast_to(rates, (given.times.size, *held.rates.shape[1:])))
    wanted = SeriesArrays(wanted.times, change.factor * wanted.values)
    stepped = held.interpolation == "step"
    times, rates = _from(time, SeriesArrays(held.times, held.rates), wanted, stepped=stepped)
    return replace(held, times=times, rates=rates)


def _breach(held: Breach, base: Breach, change: ForcingChange, time: float) -> Breach:
    if held.start == "time" and time > 0.0 and held.start_time <= time:
        return held  # it has begun and keeps its course
    if change.start_time is None:
        return replace(held, start=base.start, start_time=base.start_time)
    return replace(
        held, start="time", start_time=NEVER if change.start_time == "never" else change.start_time
    )


def _from(
    time: float, held: SeriesArrays, wanted: SeriesArrays, stepped: bool = False, holds_first: bool = False
) -> SeriesArrays:
    if time <= 0.0:
        return wanted
    return join_series(held, wanted, time, stepped, holds_first)


def _arrays(series: ForcingSeries) -> SeriesArrays:
    return SeriesArrays(np.array(series.times, np.float64), np.array(series.values, np.float64))
