import itertools
import math
import tempfile
from datetime import datetime
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from solver_service.errors import CaseError
from solver_service.scenario.quantities import DISCHARGE
from solver_service.scenario.series import read_series

START = datetime.fromisoformat("2024-06-01T12:00:00+02:00")


def written(folder: Path, text: str) -> Path:
    path = folder / "inflow.csv"
    path.write_text(text, encoding="utf-8")
    return path


def test_seconds_and_values_are_read(tmp_path: Path) -> None:
    series = read_series(written(tmp_path, "\ufefftime_s,discharge\n0,1.5\n\n60,20\n"), None, DISCHARGE)

    np.testing.assert_array_equal(series.times, [0.0, 60.0])
    np.testing.assert_array_equal(series.values, [1.5, 20.0])


def test_clock_times_count_from_the_start_whatever_their_offset(tmp_path: Path) -> None:
    path = written(tmp_path, "time,q\n2024-06-01T10:00:00Z,1\n2024-06-01T12:30:00+02:00,2\n")

    assert read_series(path, START, DISCHARGE).times.tolist() == [0.0, 1800.0]
    with pytest.raises(CaseError, match=r"then \[case\] start_time is needed"):
        read_series(path, None, DISCHARGE)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "is empty; line 1 must name the columns"),
        ("0,1\n60,2\n", "line 1 must name the columns"),
        ("time_s,q\n", "has no line of values"),
        ("time_s,q\n0,1\n0,2\n", "line 3 is at 0 s, not after 0 s"),
        ("time_s,q\n0,-1\n", "line 2 has a discharge of -1 m3/s; 0 to 1e\\+08 m3/s is allowed"),
        ("time_s,q\n0,nan\n", "a finite number is allowed"),
        ("time_s,q\n0\n", "line 2 has 1 cells; line 1 names 2 columns"),
        ("time_s,q\nzero,1\n", "line 2 has 'zero' in column 'time_s', which is not a number"),
        ("time,q\n2024-06-01T10:00:00,1\n", "without an offset"),
    ],
)
def test_what_is_no_series_is_refused_with_its_line(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(CaseError, match=f"inflow.csv: .*{message}"):
        read_series(written(tmp_path, text), START, DISCHARGE)


NUMBERS = st.one_of(
    st.floats(-1e9, 1e9, allow_nan=False), st.sampled_from([math.nan, math.inf, -math.inf, 0.0, -1.0, 2e8])
)


@given(st.lists(st.tuples(NUMBERS, NUMBERS), max_size=6))
def test_a_series_is_read_exactly_where_it_can_be_believed(rows: list[tuple[float, float]]) -> None:
    times, values = [time for time, _ in rows], [value for _, value in rows]
    sound = bool(rows) and all(map(math.isfinite, (*times, *values)))
    sound = sound and all(a < b for a, b in itertools.pairwise(times))
    sound = sound and all(DISCHARGE.low <= value <= DISCHARGE.high for value in values)
    with tempfile.TemporaryDirectory() as folder:
        path = written(Path(folder), "time_s,q\n" + "".join(f"{time!r},{value!r}\n" for time, value in rows))
        if sound:
            series = read_series(path, None, DISCHARGE)
            assert (series.times.tolist(), series.values.tolist()) == (times, values)
        else:
            with pytest.raises(CaseError, match=r"^inflow.csv: (line \d|has no line of values)") as caught:
                read_series(path, None, DISCHARGE)
            assert str(caught.value).endswith(".")
            assert "\n" not in str(caught.value)
