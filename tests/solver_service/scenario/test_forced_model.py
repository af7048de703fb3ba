"""Changes of forcing become models that agree with the past of a run."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from protocol import ForcingChange, ForcingSeries
from solver_service.numerics import FloodModel, Source
from solver_service.numerics.joined_series import SeriesArrays, value_at
from solver_service.scenario import Case, load_case
from solver_service.scenario.forced_model import NEVER, Changes, ForcedFrom, forced_model, stretches

EXAMPLE = Path(__file__).parents[3] / "examples" / "levee_breach"


@pytest.fixture(scope="module")
def case() -> Case:
    loaded = load_case(EXAMPLE)
    spring = Source([5, 6], [5, 5], [0.0, 100.0], [0.0, 10.0], id="spring")
    return replace(loaded, model=replace(loaded.model, sources=(spring,)))


def forced(case: Case, *course: tuple[float, Changes]) -> FloodModel:
    return forced_model(case, tuple(ForcedFrom(time, changes) for time, changes in course))


def inflow(model: FloodModel, time: float) -> float:
    source = model.sources[0]
    return float(value_at(SeriesArrays(source.times, source.discharge), time, False, False))


def test_without_changes_the_model_is_that_of_the_case(case: Case) -> None:
    assert forced(case) is case.model
    assert forced(case, (0.0, ()), (60.0, (ForcingChange("spring"),))) is case.model


def test_a_factor_counts_from_its_time_on(case: Case) -> None:
    model = forced(case, (50.0, (ForcingChange("spring", 2.0),)))
    assert [inflow(model, t) for t in (20.0, 50.0)] == [2.0, 5.0]
    assert [inflow(model, t) for t in (60.0, 500.0)] == pytest.approx([12.0, 20.0])


def test_at_time_zero_the_changed_series_stands_alone(case: Case) -> None:
    series = ForcingSeries((0.0, 40.0), (8.0, 4.0))
    model = forced(case, (0.0, (ForcingChange("spring", 0.5, series=series),)))
    assert model.sources[0].times.tolist() == [0.0, 40.0]
    assert model.sources[0].discharge.tolist() == [4.0, 2.0]


def test_each_change_rules_until_the_next_and_an_empty_list_is_the_case_again(case: Case) -> None:
    doubled = (ForcingChange("spring", 2.0),)
    model = forced(case, (20.0, doubled), (40.0, doubled), (60.0, ()))
    assert [inflow(model, t) for t in (10.0, 30.0, 50.0)] == pytest.approx([1.0, 6.0, 10.0])
    assert [inflow(model, t) for t in (60.1, 100.0, 900.0)] == pytest.approx([6.01, 10.0, 10.0])


def test_a_level_is_a_real_elevation_and_may_be_raised(case: Case) -> None:
    offset = case.grid.datum_offset
    model = forced(case, (0.0, (ForcingChange("river", offset=0.5),)))
    assert model.boundaries[0].values == pytest.approx(case.model.boundaries[0].values + 0.5)
    given = forced(case, (0.0, (ForcingChange("river", series=ForcingSeries((0.0,), (3.25,))),)))
    assert given.boundaries[0].values == pytest.approx([3.25 - offset])


def test_rain_keeps_its_steps_and_comes_in_millimetres_per_hour(case: Case) -> None:
    series = ForcingSeries((0.0, 90.0), (36.0, 0.0))
    model = forced(case, (60.0, (ForcingChange("rain", series=series),)))
    assert model.rain is not None
    rain = SeriesArrays(model.rain.times, model.rain.rates)
    assert float(value_at(rain, 60.0, True, False).max()) == pytest.approx(1e-5)
    assert float(value_at(rain, 95.0, True, False).max()) == 0.0
    assert case.model.rain is not None
    before = SeriesArrays(case.model.rain.times, case.model.rain.rates)
    assert value_at(rain, 30.0, True, False) == value_at(before, 30.0, True, False)


def test_rain_may_come_to_a_case_without_any(case: Case) -> None:
    dry = replace(case, model=replace(case.model, rain=None))
    change = ForcingChange("rain", series=ForcingSeries((0.0,), (36.0,)))
    model = forced(dry, (60.0, (change,)), (120.0, ()))
    assert model.rain is not None
    rain = SeriesArrays(model.rain.times, model.rain.rates)
    found = [float(value_at(rain, t, False, False).max()) for t in (30.0, 90.0, 130.0)]
    assert found == pytest.approx([0.0, 1e-5, 0.0])


def test_a_breach_that_has_not_begun_is_moved_and_one_that_has_keeps_its_course(case: Case) -> None:
    moved = forced(case, (120.0, (ForcingChange("levee", start_time=180.0),)))
    assert (moved.breaches[0].start, moved.breaches[0].start_time) == ("time", 180.0)
    never = forced(case, (120.0, (ForcingChange("levee", start_time="never"),)))
    assert never.breaches[0].start_time == NEVER > case.duration
    back = forced(case, (120.0, (ForcingChange("levee", start_time="never"),)), (240.0, ()))
    assert back.breaches[0].start_time == 300.0
    begun = forced(case, (360.0, (ForcingChange("levee", start_time="never"),)))
    assert begun.breaches[0] == case.model.breaches[0]


def test_only_what_changes_something_begins_a_stretch(case: Case) -> None:
    doubled = (ForcingChange("spring", 2.0),)
    course = (
        ForcedFrom(0.0, ()),
        ForcedFrom(10.0, doubled),
        ForcedFrom(20.0, (*doubled, ForcingChange("rain"))),
        ForcedFrom(30.0, ()),
    )
    assert [stretch.time for stretch in stretches(course)] == [10.0, 30.0]
    assert np.array_equal(
        forced_model(case, course).sources[0].discharge,
        forced_model(case, stretches(course)).sources[0].discharge,
    )
