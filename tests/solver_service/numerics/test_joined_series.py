"""A joined series is the first one up to the join and the second one from then on."""

import numpy as np
import pytest

from solver_service.numerics.joined_series import SeriesArrays, join_series, value_at

JOIN = 100.0


def series(*pairs: tuple[float, float]) -> SeriesArrays:
    return SeriesArrays(*np.array(pairs, np.float64).T)


FIRST = series((0.0, 0.0), (200.0, 20.0))
SECOND = series((50.0, 3.0), (150.0, 5.0), (300.0, 0.0))


@pytest.mark.parametrize("stepped", [False, True])
@pytest.mark.parametrize("holds_first", [False, True])
def test_each_series_rules_on_its_side_of_the_join(stepped: bool, holds_first: bool) -> None:
    joined = join_series(FIRST, SECOND, JOIN, stepped, holds_first)
    assert (np.diff(joined.times) > 0.0).all()
    for time in (0.0, 20.0, 99.9):
        assert value_at(joined, time, stepped, holds_first) == value_at(FIRST, time, stepped, holds_first)
    for time in (100.1, 149.0, 150.0, 299.0, 1e6):
        wanted = value_at(SECOND, time, stepped, holds_first)
        assert value_at(joined, time, stepped, holds_first) == pytest.approx(wanted, rel=1e-12)


def test_a_second_series_that_begins_later_gives_nothing_until_then_unless_it_holds() -> None:
    late = series((150.0, 4.0))
    silent = join_series(FIRST, late, JOIN, stepped=False, holds_first=False)
    assert [float(value_at(silent, t, False, False)) for t in (101.0, 149.9, 150.0)] == [0.0, 0.0, 4.0]
    held = join_series(FIRST, late, JOIN, stepped=False, holds_first=True)
    assert float(value_at(held, 101.0, False, True)) == 4.0


def test_the_integral_up_to_the_join_is_that_of_the_first_series() -> None:
    joined = join_series(FIRST, SECOND, JOIN, stepped=False, holds_first=False)
    before = joined.times <= JOIN
    volume = np.trapezoid(joined.values[before], joined.times[before])
    assert volume == pytest.approx(0.5 * JOIN * 10.0, rel=1e-15)


def test_joining_again_at_the_same_time_takes_the_last_series() -> None:
    once = join_series(FIRST, SECOND, JOIN, stepped=False, holds_first=False)
    again = join_series(once, FIRST, JOIN, stepped=False, holds_first=False)
    assert (np.diff(again.times) > 0.0).all()
    assert float(value_at(again, 150.0, False, False)) == pytest.approx(15.0, rel=1e-12)


def test_values_may_be_rasters() -> None:
    first = SeriesArrays(np.array([0.0]), np.array([[1.0, 2.0]]))
    second = SeriesArrays(np.array([0.0]), np.array([[5.0, 0.0]]))
    joined = join_series(first, second, JOIN, stepped=True, holds_first=False)
    assert joined.times.tolist() == [0.0, JOIN]
    assert joined.values.tolist() == [[1.0, 2.0], [5.0, 0.0]]
