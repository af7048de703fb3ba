from pathlib import Path

import pytest

from solver_service.errors import CaseError
from solver_service.scenario import load_case
from solver_service.scenario.places import read_points
from tests.solver_service.tiny_case import CASE, GAUGES, write_case


def test_gauges_and_sections_are_recorded_by_the_solver(tmp_path: Path) -> None:
    case = load_case(write_case(tmp_path, CASE + GAUGES))

    assert [gauge.id for gauge in case.gauges] == ["upper", "lower"]
    assert case.params.gauges == ((5.0, 12.0), (15.0, 12.0))
    (section,) = case.params.sections
    assert (section.id, section.line) == ("dam", ((9.5, 23.5), (9.5, -0.5)))
    assert {tuple(face) for face in section.chain(case.grid.shape).faces.tolist()} == {
        (row, 9, 0) for row in range(24)
    }


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
        (
            '[[section]]\nid = "s"\nline = [[1100.0, 2100.0], [1100.0, 2100.0]]',
            "differ each from the one",
        ),
        (
            '[[section]]\nid = "s"\nline = [[1100.0, 2100.0], [9.0, 9.0]]',
            r"\(9, 9\) lies off the terrain",
        ),
    ],
)
def test_a_bad_place_is_told(tmp_path: Path, more: str, message: str) -> None:
    with pytest.raises(CaseError, match=message):
        load_case(write_case(tmp_path, f"{CASE}\n{more}\n"))


def written(folder: Path, text: str) -> Path:
    path = folder / "points.csv"
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize("header", ["id,x,y", "id,kind,x_m,y_m"])
def test_points_are_read_by_the_names_of_their_columns(tmp_path: Path, header: str) -> None:
    kind = "mark," if "kind" in header else ""

    assert read_points(written(tmp_path, f"{header}\nP1,{kind}1.5,2\n")) == [("P1", 1.5, 2.0)]


@pytest.mark.parametrize(
    "text",
    ["id,x\nP1,3\n", "id,x,y\nP1,3\n", "id,x,y\nP1,3,inf\n", "x,y\n1,2\n", "id,x,y\nP1,,2\n", ""],
)
def test_what_is_no_point_is_refused_with_its_line(tmp_path: Path, text: str) -> None:
    with pytest.raises(CaseError, match=r"points.csv: (line [12] |is empty; line 1 )"):
        read_points(written(tmp_path, text))
