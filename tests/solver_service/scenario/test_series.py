from datetime import datetime
from pathlib import Path

import numpy as np
import pytest

from solver_service.errors import CaseError
from solver_service.scenario.series import read_points, read_series

START = datetime.fromisoformat("2024-06-01T12:00:00+02:00")


def written(folder: Path, text: str) -> Path:
    path = folder / "inflow.csv"
    path.write_text(text, encoding="utf-8")
    return path


def test_seconds_and_values_are_read(tmp_path: Path) -> None:
    series = read_series(written(tmp_path, "\ufefftime_s,discharge\n0,1.5\n\n60,20\n"))

    np.testing.assert_array_equal(series.times, [0.0, 60.0])
    np.testing.assert_array_equal(series.values, [1.5, 20.0])


def test_clock_times_count_from_the_start_whatever_their_offset(tmp_path: Path) -> None:
    path = written(tmp_path, "time,q\n2024-06-01T10:00:00Z,1\n2024-06-01T12:30:00+02:00,2\n")

    assert read_series(path, START).times.tolist() == [0.0, 1800.0]
    with pytest.raises(CaseError, match=r"then \[case\] start_time is needed"):
        read_series(path)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "line 1 must name the columns"),
        ("0,1\n60,2\n", "line 1 must name the columns"),
        ("time_s,q\n", "has no line of values"),
        ("time_s,q\n0,1\n0,2\n", "line 3 is at 0.0 s, not after 0.0 s"),
        ("time_s,q\n0,-1\n", "line 2 has -1.0 at 0.0 s"),
        ("time_s,q\n0,nan\n", "finite numbers"),
        ("time_s,q\n0\n", "line 2 '0' is not a time and a number"),
        ("time_s,q\nzero,1\n", "line 2 'zero,1' is not a time and a number"),
        ("time,q\n2024-06-01T10:00:00,1\n", "is not a time and a number"),
    ],
)
def test_what_is_no_series_is_refused_with_its_line(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(CaseError, match=f"inflow.csv: .*{message}"):
        read_series(written(tmp_path, text), START)


@pytest.mark.parametrize("header", ["id,x,y", "id,kind,x_m,y_m"])
def test_points_are_read_by_the_names_of_their_columns(tmp_path: Path, header: str) -> None:
    kind = "mark," if "kind" in header else ""

    assert read_points(written(tmp_path, f"{header}\nP1,{kind}1.5,2\n")) == [("P1", 1.5, 2.0)]


@pytest.mark.parametrize("text", ["id,x\nP1,3\n", "id,x,y\nP1,3\n", "id,x,y\nP1,3,inf\n", "x,y\n1,2\n"])
def test_what_is_no_point_is_refused_with_its_line(tmp_path: Path, text: str) -> None:
    with pytest.raises(CaseError, match=r"inflow.csv: line 2"):
        read_points(written(tmp_path, text))
