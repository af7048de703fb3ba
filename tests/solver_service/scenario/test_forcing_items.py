"""What viewers are told of the forcing of a case, in the units and elevations of its case file."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from protocol import ForcingItem
from solver_service.numerics import FloodModel, Source
from solver_service.scenario import Case, load_case
from solver_service.scenario.forcing_items import forcing_items, places

EXAMPLE = Path(__file__).parents[3] / "examples" / "levee_breach"


@pytest.fixture(scope="module")
def case() -> Case:
    return load_case(EXAMPLE)


def test_levels_rain_and_breaches_come_as_the_case_file_says_them(case: Case) -> None:
    river, rain, levee = forcing_items(case)
    assert (river.id, river.kind, river.unit) == ("river", "stage", "m")
    assert (rain.id, rain.kind, rain.unit) == ("rain", "rain", "mm/h")
    assert levee == ForcingItem("levee", "breach", "s", start_time=300.0)
    told = np.loadtxt(EXAMPLE / "river.csv", delimiter=",", skiprows=1, usecols=1)
    assert river.series is not None
    assert river.series.times[0] == 0.0
    assert river.series.values == pytest.approx(told)
    fallen = np.loadtxt(EXAMPLE / "rain.csv", delimiter=",", skiprows=1, usecols=1)
    assert rain.series is not None
    assert rain.series.values == pytest.approx(fallen)


def test_a_case_without_rain_has_an_item_for_it_without_a_series(case: Case) -> None:
    dry = replace(case, model=replace(case.model, rain=None))
    rain = next(item for item in forcing_items(dry) if item.kind == "rain")
    assert rain.series is None
    assert rain.high > 0.0


def test_items_of_one_name_are_told_apart(case: Case) -> None:
    source = Source([5], [5], [0.0], [1.0])
    model: FloodModel = replace(
        case.model,
        sources=(
            replace(source, id="river"),
            replace(source, id="rain"),
            replace(source, id="levee"),
            source,
        ),
    )
    found = [place.id for place in places(model)]
    assert found == ["river", "source rain", "levee", "source-4", "stage river", "rain", "breach levee"]
    assert len(set(found)) == len(found)


def test_an_inflow_is_limited_by_the_rim_that_it_leaves_through(case: Case) -> None:
    model = replace(case.model, sources=(Source([5], [5], [0.0], [1.0], id="spring"),))
    spring = forcing_items(replace(case, model=model))[0]
    assert spring.high == pytest.approx(1000.0 * 2.0 * np.sqrt(np.pi) * case.model.dx)
    assert spring.low == 0.0
