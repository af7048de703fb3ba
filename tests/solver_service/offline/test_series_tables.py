from pathlib import Path

import numpy as np
import pytest

from solver_service.numerics import GaugeSeries
from solver_service.offline.series_tables import section_discharge, write_gauges, write_sections
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


def test_discharge_through_a_line_counts_positive_to_its_right(case: Case) -> None:
    # The line of the section runs south along x = 1100, 240 m long: its right is the west.
    ((discharge, area),) = section_discharge(case, series(case, 2.0, 3.0, 7.0))

    np.testing.assert_allclose(discharge, [-2.0 * 3.0 * 240.0] * 2)
    np.testing.assert_allclose(area, [480.0] * 2)


def test_sections_are_written_with_their_names(case: Case, tmp_path: Path) -> None:
    write_sections(tmp_path / "s.csv", case, series(case, 2.0, 3.0, 0.0))

    rows = rows_of(tmp_path / "s.csv")
    assert rows[0] == {
        "time_s": "0",
        "section": "dam",
        "discharge_m3_s": "-1440.0000",
        "wet_area_m2": "480.0000",
    }


def test_names_with_commas_and_quotes_survive(tmp_path: Path) -> None:
    text = CASE + "\n[[gauge]]\nid = 'a \"b\", c'\nat = [1055.0, 2125.0]\n"
    case = load_case(write_case(tmp_path / "quoted", text))

    write_gauges(tmp_path / "g.csv", case, series(case, 1.0, 0.0, 0.0))

    assert {row["gauge"] for row in rows_of(tmp_path / "g.csv")} == {'a "b", c'}
