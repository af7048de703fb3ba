"""Where the gauges and sections of a case are, as clients are told."""

from __future__ import annotations

from itertools import islice

from protocol import GaugePlace, SectionPlace, limits
from solver_service.scenario.case import Case


def gauge_places(case: Case) -> tuple[GaugePlace, ...]:
    """The gauges of a case in map coordinates; the first of too many."""
    return tuple(GaugePlace(gauge.id, gauge.x, gauge.y) for gauge in islice(case.gauges, limits.MAX_PLACES))


def section_places(case: Case) -> tuple[SectionPlace, ...]:
    """The sections of a case in map coordinates; the first of too many, long ones thinned evenly."""
    places = []
    for section in islice(case.sections, limits.MAX_PLACES):
        count = len(section.line)
        kept = min(count, limits.MAX_PLACE_POINTS)
        chosen = [round(k * (count - 1) / (kept - 1)) for k in range(kept)]
        cells = [section.line[k] for k in chosen]
        line = tuple(case.grid.center(float(row), float(column)) for column, row in cells)
        places.append(SectionPlace(section.id, line))
    return tuple(places)
