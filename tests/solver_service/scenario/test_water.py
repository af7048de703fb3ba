from pathlib import Path

import numpy as np
import pytest

from solver_service.errors import CaseError, ServiceError
from solver_service.scenario import Case, load_case
from tests.solver_service.tiny_case import CASE, COLS, DX, ROWS, X0, Y0, valley, write_case

POOL = CASE[CASE.index("[[initial.level]]") : CASE.index("[[boundary]]")]
DRY = CASE.replace(POOL, "")


def loaded(folder: Path, more: str) -> Case:
    return load_case(write_case(folder, DRY + more))


def test_without_initial_water_the_terrain_is_dry(tmp_path: Path) -> None:
    assert not loaded(tmp_path, "").initial_h.any()


def test_water_stands_level_within_its_polygon(tmp_path: Path) -> None:
    case = load_case(write_case(tmp_path))

    expected = np.maximum(306.0 - valley(), 0.0)
    expected[:, 10:] = 0.0
    np.testing.assert_allclose(case.initial_h, expected, atol=1e-4)
    assert case.initial_h.dtype == np.float32


def test_the_left_of_a_line_is_filled(tmp_path: Path) -> None:
    level = "\n[[initial.level]]\nlevel = 306.0\nside_of_line = [[1100.0, 2000.0], [1100.0, 2240.0]]\n"

    h = loaded(tmp_path, level).initial_h

    assert h[:, :10].any()
    assert not h[:, 10:].any()


def test_only_the_pool_that_holds_the_point_is_filled(tmp_path: Path) -> None:
    bed = np.full((ROWS, COLS), 10.0, np.float32)
    bed[5:10, 5:10] = 0.0
    bed[15:20, 20:25] = 0.0
    pool = "\n[[initial.level]]\nlevel = 4.0\neverywhere_below = true\nconnected_to = [1075.0, 2075.0]\n"

    h = load_case(write_case(tmp_path, DRY + pool, bed)).initial_h

    assert (h[5:10, 5:10] == 4.0).all()
    assert h.sum() == 100.0


def test_the_larger_of_two_levels_counts(tmp_path: Path) -> None:
    levels = "".join(
        f"\n[[initial.level]]\nlevel = {level}\neverywhere_below = true\n" for level in (305.0, 307.0, 306.0)
    )

    np.testing.assert_allclose(
        loaded(tmp_path, levels).initial_h, np.maximum(307.0 - valley(), 0.0), atol=1e-4
    )


def test_depth_comes_from_a_file_and_is_dry_where_it_says_nothing(tmp_path: Path) -> None:
    depth = np.zeros((ROWS, COLS), np.float32)
    depth[3, 4], depth[5, 6] = 2.5, np.nan
    write_case(tmp_path, DRY + '\n[initial]\ndepth = "d.npz"\ndepth_key = "h0"\nrow0 = "north"\n')
    np.savez(tmp_path / "d.npz", h0=depth[::-1])

    h = load_case(tmp_path).initial_h

    assert h[3, 4] == 2.5
    assert h.sum() == 2.5


def test_a_negative_depth_names_its_cell(tmp_path: Path) -> None:
    depth = np.zeros((ROWS, COLS), np.float32)
    depth[3, 4] = -0.5
    write_case(tmp_path, DRY + '\n[initial]\ndepth = "d.npz"\n')
    np.savez(tmp_path / "d.npz", depth=depth)

    with pytest.raises(
        CaseError, match=r"depth 'd.npz' is -0.5 m in cell \(row 3, column 4\); a depth at or above 0"
    ):
        load_case(tmp_path)


def test_no_water_stands_on_walls(tmp_path: Path) -> None:
    bed = valley()
    bed[12, 5] = np.nan

    case = load_case(write_case(tmp_path, bed=bed))

    assert case.initial_h[12, 5] == 0.0
    assert case.initial_h[12, 4] > 0.0


@pytest.mark.parametrize(
    ("level", "message"),
    [
        ("level = 306.0", "has no place; one of polygon, side_of_line, everywhere_below"),
        ("level = 306.0\neverywhere_below = false", "everywhere_below is False; true is allowed"),
        (
            "level = 306.0\neverywhere_below = true\npolygon = [[0,0],[1,0],[1,1]]",
            "has polygon and everywhere_below",
        ),
        ("level = nan\neverywhere_below = true", "level is nan; an elevation"),
        ("level = 306.0\nside_of_line = [[0,0],[0,0]]", "two different points"),
        ("level = 306.0\nside_of_line = [[0,0],[0,1],[0,2]]", "2 points"),
        (
            "level = 306.0\neverywhere_below = true\nconnected_to = [0.0, 0.0]",
            "a point within x 1000 to 1400",
        ),
        (
            "level = 302.0\neverywhere_below = true\nconnected_to = [1005.0, 2005.0]",
            "a point that is under water",
        ),
    ],
)
def test_a_bad_level_is_told(tmp_path: Path, level: str, message: str) -> None:
    with pytest.raises(CaseError, match=message):
        loaded(tmp_path, f"\n[[initial.level]]\n{level}\n")


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
        ('edge = "west"\nkind = "stage"', "kind is 'stage'; this version computes wall and open edges"),
        ('edge = "west"\nkind = "hole"', "kind is 'hole'; 'wall', 'open' is allowed"),
        ('edge = "west"\nkind = ["open"]', r"kind is \['open'\]"),
        ('edge = "west"\nfrom = 5.0', "from is 5.0; a coordinate in m along the edge, 2000 to 2240"),
        ('edge = "west"\nfrom = 2100.0\nto = 2101.0', "at least one cell"),
    ],
)
def test_a_bad_edge_is_told(tmp_path: Path, keys: str, message: str) -> None:
    with pytest.raises(CaseError, match=message):
        loaded(tmp_path, f"\n[[boundary]]\n{keys}\n")


def test_a_source_covers_the_cells_of_its_disc(tmp_path: Path) -> None:
    source = loaded(
        tmp_path, "\n[[source]]\nat = [1105.0, 2105.0]\nradius = 15.0\ndischarge = 20.0\n"
    ).model.sources[0]

    x, y = X0 + (source.cols + 0.5) * DX, Y0 + (source.rows + 0.5) * DX
    assert source.rows.size == 9
    assert np.hypot(x - 1105.0, y - 2105.0).max() <= 15.0
    assert source.discharge.tolist() == [20.0]


def test_a_source_follows_its_series(tmp_path: Path) -> None:
    write_case(tmp_path, DRY + '\n[[source]]\nat = [1105.0, 2105.0]\nseries = "q.csv"\n')
    (tmp_path / "q.csv").write_text("time_s,discharge\n0,0\n60,12\n")

    source = load_case(tmp_path).model.sources[0]

    assert (source.rows.tolist(), source.cols.tolist()) == ([10], [10])
    assert source.times.tolist() == [0.0, 60.0]
    assert source.discharge.tolist() == [0.0, 12.0]


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ("at = [1105.0, 2105.0]", "either 'discharge' in m3/s or 'series'"),
        ("at = [1105.0, 2105.0]\ndischarge = -1.0", "discharge is -1.0; a discharge in m3/s at or above 0"),
        (
            "at = [5.0, 5.0]\ndischarge = 1.0",
            r"at is \[5.0, 5.0\]; a point within x 1000 to 1400 and y 2000 to 2240",
        ),
        ("at = [1105.0, 2105.0]\ndischarge = 1.0\nradius = -2.0", "radius is -2.0"),
        ('at = [1105.0, 2105.0]\nseries = "../q.csv"', "series is '../q.csv'; a relative path"),
    ],
)
def test_a_bad_source_is_told(tmp_path: Path, keys: str, message: str) -> None:
    with pytest.raises(CaseError, match=message):
        loaded(tmp_path, f"\n[[source]]\n{keys}\n")


def test_rain_is_read_in_mm_an_hour(tmp_path: Path) -> None:
    write_case(tmp_path, DRY + '\n[rain]\nseries = "rain.csv"\n')
    (tmp_path / "rain.csv").write_text("time_s,rain\n0,36\n600,0\n")

    rain = load_case(tmp_path).model.rain

    assert rain.times.tolist() == [0.0, 600.0]
    np.testing.assert_allclose(rain.rates.ravel(), [1e-5, 0.0])
    constant = loaded(tmp_path / "b", "\n[rain]\nrate = 36.0\n").model.rain
    np.testing.assert_allclose(constant.rates.ravel(), [1e-5])


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ("rate = -1.0", "rate is -1.0"),
        ("", "either 'series' .* or 'rate'"),
        ('series = "rain.nc"', "rain that is the same everywhere"),
        ('series = "none.csv"', "does not exist"),
    ],
)
def test_bad_rain_is_told(tmp_path: Path, keys: str, message: str) -> None:
    with pytest.raises(ServiceError, match=message):
        loaded(tmp_path, f"\n[rain]\n{keys}\n")
