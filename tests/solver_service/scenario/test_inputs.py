import re
from pathlib import Path

import numpy as np
import pytest

from solver_service.errors import CaseError, ServiceError
from solver_service.scenario import load_case
from tests.solver_service.dry_case import DRY, loaded
from tests.solver_service.tiny_case import COLS, ROWS, write_case

SOURCE = "\n[[source]]\nat = [1105.0, 2105.0]\n"
BOW_TIE = "[[1000, 2000], [1100, 2100], [1100, 2000], [1000, 2100]]"
SPECK = "[[1001, 2001], [1002, 2001], [1002, 2002]]"


@pytest.mark.parametrize(
    ("series", "message"),
    [
        ("time_s,q\n0,5\n60,1.05e6\n", "q.csv: a discharge of 1.05e\\+06 m3/s is odd"),
        ("time_s,q\n5,5\n60,0\n", "q.csv: begins at 5 s, after the start of the run"),
        ("time_s,q\n0,5\n6,7\n", "q.csv: ends at 6 s and the run at 20 s; its last value of 7 m3/s is held"),
        ("time_s,q\n0,1\n1,1\n2,1\n3,1\n30,1\n", "q.csv: says nothing between 3 and 30 s"),
    ],
)
def test_odd_series_are_told_and_still_run(tmp_path: Path, series: str, message: str) -> None:
    write_case(tmp_path, DRY + SOURCE + 'series = "q.csv"\nradius = 10000.0\n')
    (tmp_path / "q.csv").write_text(series)

    (warning,) = load_case(tmp_path).warnings

    assert re.search(message, warning)


def test_a_sound_case_has_no_warnings(tmp_path: Path) -> None:
    write_case(tmp_path, DRY + SOURCE + 'series = "q.csv"\n')
    (tmp_path / "q.csv").write_text("time_s,q_l_s\n0,5\n10,9\n25,1\n")

    case = load_case(tmp_path)

    assert case.warnings == ()
    np.testing.assert_allclose(case.model.sources[0].discharge, [5e-3, 9e-3, 1e-3])


@pytest.mark.parametrize(
    ("series", "message"),
    [
        ("time_s,q_cfs\n0,5\n", "q.csv: column 'q_cfs' is in ft3/s; a discharge in m3/s, l/s is allowed"),
        ("time_s,level_m\n0,5\n", "q.csv: column 'level_m' is in m; a discharge"),
        ("time_s,q\n0,\n", "q.csv: line 2 has no 'q'; a number is needed in every line, so fill the gap"),
        ("time_s,q\n-60,5\n-1,5\n", "q.csv: ends at -1 s, before the run begins"),
        (
            "time_s,q\n0,9e9\n",
            r"line 2 has a discharge of 9e\+09 m3/s; 0 to 1e\+08 m3/s is allowed, so check",
        ),
        (
            "time_s,q\n0,200000\n",
            "series is 'q.csv'; it brings 5641.9 m2/s per metre of the rim of its 1 cells",
        ),
    ],
)
def test_bad_series_are_refused_with_what_to_change(tmp_path: Path, series: str, message: str) -> None:
    write_case(tmp_path, DRY + SOURCE + 'series = "q.csv"\n')
    (tmp_path / "q.csv").write_text(series)

    with pytest.raises(CaseError, match=message) as caught:
        load_case(tmp_path)

    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("table", "message"),
    [
        (
            f"[[roughness.zone]]\nmanning_n = 0.1\npolygon = {BOW_TIE}",
            r"zone\]\] number 1 polygon is .*crosses itself",
        ),
        (f"[[terrain.raise]]\nby = 1.0\npolygon = {BOW_TIE}", "crosses itself"),
        (f"[[initial.level]]\nlevel = 306.0\npolygon = {BOW_TIE}", "crosses itself"),
        (
            f"[[roughness.zone]]\nmanning_n = 0.1\npolygon = {SPECK}",
            r"number 1 covers no cell of the terrain",
        ),
        (f"[[initial.level]]\nlevel = 306.0\npolygon = {SPECK}", "covers no cell"),
    ],
)
def test_bad_polygons_are_told(tmp_path: Path, table: str, message: str) -> None:
    with pytest.raises(CaseError, match=message):
        loaded(tmp_path, f"\n{table}\n")


def test_a_raster_in_another_system_is_refused(tmp_path: Path) -> None:
    text = DRY.replace('crs = "local"', 'crs = "EPSG:32632"').replace("manning_n = 0.03", 'raster = "n.asc"')
    write_case(tmp_path, text)
    lines = [f"ncols {COLS}", f"nrows {ROWS}", "xllcorner 1000", "yllcorner 2000", "cellsize 10"]
    (tmp_path / "n.asc").write_text("\n".join(lines) + ("\n" + " 0.03" * COLS) * ROWS + "\n")
    assert load_case(tmp_path).model.manning_n.mean() == pytest.approx(0.03)

    from pyproj import CRS

    (tmp_path / "n.prj").write_text(CRS.from_epsg(32633).to_wkt("WKT1_ESRI"))
    with pytest.raises(ServiceError, match=r"\[roughness\] raster 'n.asc' is not in 'EPSG:32632'"):
        load_case(tmp_path)


def test_a_raster_beside_the_terrain_is_refused(tmp_path: Path) -> None:
    write_case(tmp_path, DRY + '\n[initial]\ndepth = "d.npz"\n')
    np.savez(tmp_path / "d.npz", depth=np.ones((ROWS, COLS)), x0=0.0, y0=0.0, dx=10.0)

    message = r"depth is 'd.npz'; it covers .* \[0.0, 0.0, 400.0, 240.0\] m and says nothing on the terrain"
    with pytest.raises(CaseError, match=message):
        load_case(tmp_path)
