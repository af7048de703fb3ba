from pathlib import Path

import pytest

from solver_service.errors import CaseError
from solver_service.scenario import load_case
from tests.solver_service.tiny_case import CASE, GAUGES, write_case


def test_gauges_then_section_points_are_recorded_by_the_solver(tmp_path: Path) -> None:
    case = load_case(write_case(tmp_path, CASE + GAUGES))

    assert [gauge.id for gauge in case.gauges] == ["upper", "lower"]
    assert case.params.gauges[:2] == ((5.0, 12.0), (15.0, 12.0))
    assert len(case.params.gauges) == 2 + case.sections[0].x.size == 26
    assert {col for col, _ in case.params.gauges[2:]} == {10.0}


def test_gauges_of_a_file_follow_those_of_the_case(tmp_path: Path) -> None:
    write_case(tmp_path, 'gauges = "g.csv"\n' + CASE + GAUGES)
    (tmp_path / "g.csv").write_text("id,x,y\nP1,1001,2001\n")

    assert [gauge.id for gauge in load_case(tmp_path).gauges] == ["upper", "lower", "P1"]


def test_a_gauge_on_the_outer_edge_takes_the_last_cell(tmp_path: Path) -> None:
    case = load_case(write_case(tmp_path, CASE + '\n[[gauge]]\nid = "corner"\nat = [1400.0, 2240.0]\n'))

    assert case.params.gauges == ((39.0, 23.0),)


@pytest.mark.parametrize(
    ("more", "message"),
    [
        (
            '[[gauge]]\nid = "a"\nat = [0.0, 0.0]',
            r"gauge 'a' is at \(0, 0\), outside the terrain; x 1000 to 1400",
        ),
        (
            '[[gauge]]\nid = "a"\nat = [1100.0, 2100.0]\n[[gauge]]\nid = "a"\nat = [1100.0, 2100.0]',
            "'a' is empty or stands twice",
        ),
        ("[[gauge]]\nid = 5\nat = [1100.0, 2100.0]", r"\[\[gauge\]\] number 1 id is 5; a text"),
        ('[[gauge]]\nid = "a"\nat = [1100.0]', "a point"),
        ('[[gauge]]\nname = "a"\nat = [1100.0, 2100.0]', "unknown key 'name'"),
        ('[[section]]\nid = "s"\nline = [[1100.0, 2100.0]]', "2 to 4096 points"),
        ('[[section]]\nid = "s"\nline = [[1100.0, 2100.0], [1100.0, 2100.0]]', "a line of some length"),
        (
            '[[section]]\nid = "s"\nline = [[1100.0, 2100.0], [9.0, 9.0]]',
            r"section 's' is at \(9, 9\), outside",
        ),
    ],
)
def test_a_bad_place_is_told(tmp_path: Path, more: str, message: str) -> None:
    with pytest.raises(CaseError, match=message):
        load_case(write_case(tmp_path, f"{CASE}\n{more}\n"))


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        (
            "line = [[1100.0, 2100.0], [1200.0, 2100.0]]\nwidth = 0.0\nmagnitude = 2.0",
            "width is 0.0; a width in m above 0",
        ),
        ("line = [[1100.0, 2100.0], [5.0, 5.0]]\nwidth = 20.0\nmagnitude = 2.0", "outside the terrain"),
        (
            'line = [[1100.0, 2100.0], [1200.0, 2100.0]]\nwidth = 20.0\nmagnitude = 2.0\ntype = "replace"',
            "needs 'level'",
        ),
        (
            'line = [[1100.0, 2100.0], [1200.0, 2100.0]]\nwidth = 20.0\nmagnitude = 2.0\noperation = "dig"',
            "'raise', 'lower'",
        ),
    ],
)
def test_a_bad_edit_of_the_tour_is_told(tmp_path: Path, keys: str, message: str) -> None:
    with pytest.raises(CaseError, match=message):
        load_case(write_case(tmp_path, f"{CASE}\n[demo]\n[[demo.edit]]\n{keys}\n"))
