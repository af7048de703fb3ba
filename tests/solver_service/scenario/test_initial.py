from pathlib import Path

import numpy as np
import pytest

from solver_service.errors import CaseError
from solver_service.scenario import load_case
from tests.solver_service.dry_case import DRY, loaded
from tests.solver_service.tiny_case import COLS, ROWS, valley, write_case


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
        ("level = 306.0", "has no place; one of polygon, polygons, side_of_line, everywhere_below"),
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
            "off the terrain; x 1000 to 1400",
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


def test_levels_come_from_a_raster_and_leave_higher_ground_dry(tmp_path: Path) -> None:
    surface = np.full((ROWS, COLS), 304.0)
    surface[:, 30:] = np.nan
    write_case(tmp_path, DRY + '\n[initial]\nsurface = "s.npz"\n')
    np.savez(tmp_path / "s.npz", surface=surface)

    expected = np.maximum(304.0 - valley(), 0.0)
    expected[:, 30:] = 0.0
    h = load_case(tmp_path).initial_h
    np.testing.assert_allclose(h, expected, atol=1e-4)
    assert (h == 0.0).any()


def test_polygons_of_a_file_hold_a_depth(tmp_path: Path) -> None:
    write_case(tmp_path, DRY + '\n[[initial.level]]\ndepth = 0.25\npolygons = "ponds.csv"\n')
    (tmp_path / "ponds.csv").write_text(
        "1000,2000\n1020,2000\n1020,2010\n\n1100,2100\n1110,2100\n1110,2110\n1100,2110\n"
    )

    h = load_case(tmp_path).initial_h

    assert h[10, 10] == 0.25
    assert sorted(np.unique(h).tolist()) == [0.0, 0.25]


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ("[[initial.level]]\neverywhere_below = true", "level is missing; either 'level' .* or 'depth'"),
        ("[[initial.level]]\nlevel = 5.0\ndepth = 5.0\neverywhere_below = true", "level is 5.0; either"),
        (
            "[[initial.level]]\ndepth = 2000.0\neverywhere_below = true",
            "depth is 2000.0; a depth",
        ),
        ("[[initial.level]]\nlevel = 9000.0\neverywhere_below = true", "check unit and vertical datum"),
        ('[initial]\nsurface_key = "s"', "surface_key is 's'; it means something only"),
        ('[initial]\nsurface = "deep.npz"', "surface is 'deep.npz'; it puts 8698.95 m of water"),
        (
            '[initial]\ndepth = "deep.npz"\ndepth_key = "surface"',
            "it puts 9000 m of water",
        ),
    ],
)
def test_absurd_water_is_told(tmp_path: Path, keys: str, message: str) -> None:
    write_case(tmp_path, f"{DRY}\n{keys}\n")
    np.savez(tmp_path / "deep.npz", surface=np.full((ROWS, COLS), 9000.0))

    with pytest.raises(CaseError, match=message):
        load_case(tmp_path)
