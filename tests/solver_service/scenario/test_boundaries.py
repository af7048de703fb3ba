from pathlib import Path

import numpy as np
import pytest

from solver_service.errors import CaseError
from solver_service.scenario import load_case
from tests.solver_service.dry_case import DRY, loaded
from tests.solver_service.tiny_case import COLS, ROWS, write_case


def test_edges_are_cut_at_whole_cells_and_walls_by_default(tmp_path: Path) -> None:
    south = '\n[[boundary]]\nedge = "south"\nkind = "open"\nfrom = 1052.0\nto = 1118.0\n'
    more = south + '\n[[boundary]]\nedge = "north"\n'

    found = loaded(tmp_path, more).model.boundaries

    assert [(b.edge, b.kind, b.first, b.last) for b in found] == [
        ("east", "open", 0, ROWS),
        ("south", "open", 5, 12),
        ("north", "wall", 0, COLS),
    ]


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ('edge = "up"', "edge is 'up'; 'west', 'east', 'south', 'north' is allowed"),
        (
            'edge = "west"\nkind = "hole"',
            "kind is 'hole'; 'wall', 'open', 'stage', 'discharge', 'normal_depth' is allowed",
        ),
        ('edge = "west"\nkind = ["open"]', r"kind is \['open'\]"),
        ('edge = "west"\nfrom = 5.0', "from is 5.0; a coordinate in m along the edge, 2000 to 2240"),
        ('edge = "west"\nfrom = 2100.0\nto = 2101.0', "at least one cell"),
    ],
)
def test_a_bad_edge_is_told(tmp_path: Path, keys: str, message: str) -> None:
    with pytest.raises(CaseError, match=message):
        loaded(tmp_path, f"\n[[boundary]]\n{keys}\n")


def test_a_stage_is_stored_from_the_datum_offset(tmp_path: Path) -> None:
    write_case(
        tmp_path, DRY + '\n[[boundary]]\nedge = "west"\nkind = "stage"\nseries = "tide.csv"\nid = "sea"\n'
    )
    (tmp_path / "tide.csv").write_text("time_s,level_cm\n0,30600\n60,30650\n")

    case = load_case(tmp_path)

    sea = case.model.boundaries[1]
    assert case.grid.datum_offset == 300.0
    assert (sea.kind, sea.id, case.model.boundaries[0].id) == ("stage", "sea", "east-1")
    assert sea.times.tolist() == [0.0, 60.0]
    np.testing.assert_allclose(sea.values, [6.0, 6.5])


def test_discharge_and_normal_depth_take_numbers(tmp_path: Path) -> None:
    edges = (
        '\n[[boundary]]\nedge = "west"\nkind = "discharge"\ndischarge = -5.0\nto = 2120.0\n'
        '\n[[boundary]]\nedge = "west"\nkind = "normal_depth"\nslope = 0.001\nfrom = 2120.0\n'
    )

    _, out, normal = loaded(tmp_path, edges).model.boundaries

    assert (out.id, out.values.tolist(), out.times.tolist()) == ("west-1", [-5.0], [0.0])
    assert (normal.id, normal.slope, normal.first, normal.last) == ("west-2", 0.001, 12, ROWS)


def test_a_level_below_the_ground_of_its_edge_is_told(tmp_path: Path) -> None:
    case = loaded(tmp_path, '\n[[boundary]]\nedge = "west"\nkind = "stage"\nlevel = 302.0\n')

    (warning,) = case.warnings
    assert "[[boundary]] number 2 holds a level of at most 302 m, below the lowest ground" in warning


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ('kind = "stage"', "level is missing; either 'level' in m or 'series'"),
        (
            'kind = "stage"\nlevel = 305.0\nseries = "q.csv"',
            "level is 305.0; either",
        ),
        ('kind = "stage"\nlevel = 30500.0', r"level is 30500.0; a water level in m from -20000 to 20000"),
        ('kind = "stage"\nlevel = 1500.0', r"highest ground is at 305.64 m; a level up to 1000 m above"),
        ('kind = "stage"\ndischarge = 3.0', "discharge is 3.0; it is not allowed where kind is 'stage'"),
        ('kind = "open"\nlevel = 3.0', "level is 3.0; it is not allowed where kind is 'open'"),
        ("level = 3.0", "level is 3.0; it is not allowed where kind is 'wall'"),
        ('kind = "discharge"\ndischarge = 1e6', "it brings 4166.67 m2/s per metre of width; up to 1000 m2/s"),
        ('kind = "discharge"\nseries = "q.csv"', "series is 'q.csv', which does not exist"),
        ('kind = "normal_depth"', "slope is missing; a bed slope above 0, up to 1"),
        ('kind = "normal_depth"\nslope = 0', "slope is 0; a bed slope above 0"),
        ('kind = "normal_depth"\nslope = 5.0', "slope is 5.0"),
    ],
)
def test_a_bad_kind_is_told(tmp_path: Path, keys: str, message: str) -> None:
    with pytest.raises(CaseError, match=message) as caught:
        loaded(tmp_path, f'\n[[boundary]]\nedge = "west"\n{keys}\n')

    assert str(caught.value).startswith("case.toml: ")


@pytest.mark.parametrize("span", ["", "from = 2000.0\nto = 2010.0", "from = 2230.0"])
def test_segments_that_overlap_are_refused_with_where(tmp_path: Path, span: str) -> None:
    message = r"\[\[boundary\]\] number 2 and number 1 both hold the eastern edge from 2\d\d0 to 2\d\d0 m"
    with pytest.raises(CaseError, match=message):
        loaded(tmp_path, f'\n[[boundary]]\nedge = "east"\nkind = "wall"\n{span}\n')
