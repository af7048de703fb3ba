from dataclasses import replace
from pathlib import Path

import pytest

from protocol import GaugePlace, limits
from solver_service.numerics.section import Section
from solver_service.scenario import Case, load_case
from solver_service.scenario.case import Gauge
from solver_service.scenario.told_places import gauge_places, section_places

EXAMPLE = Path(__file__).parents[3] / "examples" / "levee_breach"


@pytest.fixture(scope="module")
def case() -> Case:
    return load_case(EXAMPLE)


def test_places_stand_where_the_case_file_says(case: Case) -> None:
    assert gauge_places(case) == (GaugePlace("town", 305.0, 205.0), GaugePlace("river", 45.0, 205.0))
    (section,) = section_places(case)
    assert section.id == "behind the levee"
    assert section.line == (pytest.approx((230.0, 0.0)), pytest.approx((230.0, 400.0)))


def test_many_gauges_and_long_lines_are_told_in_part(case: Case) -> None:
    many = tuple(Gauge(f"g{k}", float(k), 0.0) for k in range(limits.MAX_PLACES + 5))
    line = tuple((float(k), float(k % 2)) for k in range(3 * limits.MAX_PLACE_POINTS))
    crowded = replace(case, gauges=many, sections=(Section("long", line),))

    assert [place.id for place in gauge_places(crowded)] == [f"g{k}" for k in range(limits.MAX_PLACES)]
    (section,) = section_places(crowded)
    assert len(section.line) == limits.MAX_PLACE_POINTS
    ends = case.grid.center(0.0, 0.0), case.grid.center(line[-1][1], line[-1][0])
    assert (section.line[0], section.line[-1]) == ends
