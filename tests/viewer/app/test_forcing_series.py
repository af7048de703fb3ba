from pathlib import Path

import pytest

from viewer.app.forcing_series import read_forcing_series
from viewer.commands import CommandError

START = "2024-06-01T12:00:00+02:00"


def write(folder: Path, text: str) -> Path:
    path = folder / "q.csv"
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize("column", ["discharge", "discharge_m3_s", "Q [m3/s]", "q_cms", "mean flow"])
def test_seconds_and_values_are_read(tmp_path: Path, column: str) -> None:
    path = write(tmp_path, f"time_s,{column}\n# a remark\n0,1.5\n\n60, 20\n")
    series = read_forcing_series(path, "m3/s", None)

    assert (series.times, series.values) == ((0.0, 60.0), (1.5, 20.0))


def test_clock_times_count_from_the_start_of_the_run(tmp_path: Path) -> None:
    path = write(tmp_path, "time,level_m\n2024-06-01T10:00:00Z,1\n2024-06-01T12:01:00+02:00,2\n")

    assert read_forcing_series(path, "m", START).times == (0.0, 60.0)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", "empty"),
        ("t,q\n0,1\n", "line 1 must name the columns"),
        ("time_s\n0\n", "line 1 must name the columns"),
        ("time_s,q_l_s\n0,1\n", "is in l_s; values in m3/s are allowed"),
        ("time_s,q [mm/h]\n0,1\n", "values in m3/s are allowed"),
        ("time_s,q\n", "no line of values"),
        ("time_s,q\n0,1\n0,2\n", "rising times"),
        ("time_s,q\n0\n", "line 2 has no value"),
        ("time_s,q\n0,lots\n", "line 2 has 'lots'"),
        ("time_s,q\n0,inf\n", "line 2 has 'inf'"),
        ("time,q\n2024-06-01T12:00:00,1\n", "without an offset"),
        ("time,q\nyesterday,1\n", "not an ISO 8601 time"),
        ("time_s,q\n" + "".join(f"{k},1\n" for k in range(4097)), "4097 entries; up to 4096"),
    ],
)
def test_what_is_wrong_is_refused_with_file_and_line(tmp_path: Path, text: str, told: str) -> None:
    with pytest.raises(CommandError, match=told) as refused:
        read_forcing_series(write(tmp_path, text), "m3/s", START)
    assert "q.csv" in str(refused.value)


def test_clock_times_need_a_run_with_a_clock(tmp_path: Path) -> None:
    with pytest.raises(CommandError, match="the run has none"):
        read_forcing_series(write(tmp_path, "time,q\n2024-06-01T10:00:00Z,1\n"), "m3/s", None)


def test_a_file_that_is_not_there_or_no_text_is_refused(tmp_path: Path) -> None:
    with pytest.raises(CommandError, match="cannot be read"):
        read_forcing_series(tmp_path / "none.csv", "m", None)
    (tmp_path / "q.csv").write_bytes(b"\xff\xfe\x00\xd8")
    with pytest.raises(CommandError, match="not a text file"):
        read_forcing_series(tmp_path / "q.csv", "m", None)
    (tmp_path / "q.csv").write_bytes(b"0" * (5 << 20))
    with pytest.raises(CommandError, match="larger than 4 MB"):
        read_forcing_series(tmp_path / "q.csv", "m", None)
