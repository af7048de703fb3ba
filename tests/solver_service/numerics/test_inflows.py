"""What sources and rain refuse."""

import numpy as np
import pytest

from solver_service.numerics import ModelError, Rain, Source


@pytest.mark.parametrize(
    ("times", "rates", "words"),
    [
        ([0.0, 0.0], [1.0, 1.0], "not after"),
        ([0.0], [-1.0], "finite value >= 0 "),
        ([0.0, 1.0], [1.0], "as many"),
    ],
)
def test_a_series_that_is_not_valid_is_refused(times, rates, words):
    with pytest.raises(ModelError, match=words):
        Source([1], [1], times, rates)


def test_a_source_that_names_a_cell_twice_is_refused():
    with pytest.raises(ModelError, match="twice"):
        Source([1, 1], [2, 2], [0.0], [1.0])


RATES = np.full((2, 2, 3), 1e-6)
FULL = ([0.0, 60.0], RATES, [0, 0, 1], [0, 1, 2, 2])


def with_rate(value):
    rates = RATES.copy()
    rates[1, 1, 2] = value
    return rates


@pytest.mark.parametrize(
    ("place", "value", "words"),
    [
        (1, with_rate(np.nan), "Entry 1 of the series of rain is nan at 60.0 s"),
        (1, with_rate(-1e-9), "Entry 1 of the series of rain is -1e-09"),
        (1, RATES[:1], "2 times and 1 values"),
        (1, RATES[0], "rain rows, rain columns"),
        (0, [60.0, 60.0], "not after"),
        (0, [0.0, np.inf], "at inf s"),
        (2, [0, 0, 2], "row index points off its 2 rows"),
        (3, [0, -1, 2, 2], "column index points off its 3 columns"),
    ],
)
def test_rain_that_is_not_valid_is_refused_in_one_sentence(place, value, words):
    parts = list(FULL)
    Rain(*parts)
    parts[place] = value
    with pytest.raises(ModelError, match=words) as caught:
        Rain(*parts)
    assert "\n" not in str(caught.value)


def test_an_unknown_interpolation_is_refused():
    with pytest.raises(ModelError, match="'cubic'"):
        Rain(*FULL, interpolation="cubic")
