from pathlib import Path

import numpy as np
import pytest

from solver_service.numerics import GaugeSeries
from solver_service.numerics.section import SectionSeries
from solver_service.offline.series_tables import write_gauges, write_sections
from solver_service.scenario import Case, load_case
from tests.solver_service.tiny_case import CASE, GAUGES, rows_of, write_case


@pytest.fixture
def case(tmp_path: Path) -> Case:
    return load_case(write_case(tmp_path / "case", CASE + GAUGES))


def series(case: Case, h: float, u: float, v: float) -> GaugeSeries:
    """Two records of uniform flow at all recorded places."""
    shape = (2, len(case.params.gauges))
    full = [np.full(shape, value, np.float32) for value in (h, 4.0 + h, u, v)]
    return GaugeSeries(np.array([0.0, 1.0]), *full)


def test_gauges_are_one_line_for_each_time_and_place_with_real_levels(case: Case, tmp_path: Path) -> None:
    write_gauges(tmp_path / "g.csv", case, series(case, 2.0, 3.0, -1.0))

    rows = rows_of(tmp_path / "g.csv")
    assert list(rows[0]) == ["time_s", "gauge", "depth_m", "level_m", "u_m_s", "v_m_s"]
    assert [(row["time_s"], row["gauge"]) for row in rows] == [
        ("0", "upper"),
        ("1", "upper"),
        ("0", "lower"),
        ("1", "lower"),
    ]
    assert rows[1] | {} == {
        "time_s": "1",
        "gauge": "upper",
        "depth_m": "2.0000",
        "level_m": "306.0000",
        "u_m_s": "3.0000",
        "v_m_s": "-1.0000",
    }


def test_sections_are_written_with_their_names(tmp_path: Path) -> None:
    columns = [np.array([[1.0, 2.0], [3.0, 4.0]]) * scale for scale in (1.0, 10.0, 100.0)]

    write_sections(tmp_path / "s.csv", ["dam", "a, b"], SectionSeries(np.array([0.0, 1.5]), *columns))

    rows = rows_of(tmp_path / "s.csv")
    assert [row["section"] for row in rows] == ["dam", "dam", "a, b", "a, b"]
    assert rows[3] == {
        "time_s": "1.5",
        "section": "a, b",
        "discharge_m3_s": "4.0000",
        "wet_area_m2": "400.0000",
        "volume_m3": "40",
    }


def test_names_with_commas_and_quotes_survive(tmp_path: Path) -> None:
    text = CASE + "\n[[gauge]]\nid = 'a \"b\", c'\nat = [1055.0, 2125.0]\n"
    case = load_case(write_case(tmp_path / "quoted", text))

    write_gauges(tmp_path / "g.csv", case, series(case, 1.0, 0.0, 0.0))

    assert {row["gauge"] for row in rows_of(tmp_path / "g.csv")} == {'a "b", c'}
