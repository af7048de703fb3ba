from pathlib import Path

import numpy as np
import pytest
import rasterio
from rasterio.transform import from_origin

from solver_service.errors import ServiceError
from solver_service.scenario import load_case
from tests.solver_service.dry_case import DRY
from tests.solver_service.tiny_case import COLS, ROWS, X0, Y0, write_case

FILES = '\n[rain]\nseries = "radar.csv"\n'
RADAR = np.arange(1.0, 7.0).reshape(2, 3) * 10.0
"""[mm/h], 2 x 3 cells of 150 m, row 0 in the south; the terrain reaches 400 m east and 240 m north."""


def write_tiff(path: Path, bands: list[np.ndarray], unit: str = "mm/h", x0: float = X0 - 30.0) -> None:
    place = from_origin(x0, Y0 - 20.0 + 300.0, 150.0, 150.0)
    size = {"height": 2, "width": 3, "count": len(bands), "dtype": "float32", "transform": place}
    with rasterio.open(path, "w", driver="GTiff", **size) as file:
        for number, values in enumerate(bands, start=1):
            file.write(values[::-1].astype(np.float32), number)
        file.units = (unit,) * len(bands)


def expected_index() -> tuple[np.ndarray, np.ndarray]:
    y, x = (np.arange(count) * 10.0 + 5.0 for count in (ROWS, COLS))
    return ((y + 20.0) // 150.0).astype(int), ((x + 30.0) // 150.0).astype(int)


def test_coarse_rasters_are_mapped_to_cells_by_their_own_place(tmp_path: Path) -> None:
    write_case(tmp_path, DRY + FILES)
    write_tiff(tmp_path / "a.tif", [RADAR])
    write_tiff(tmp_path / "b.tif", [2.0 * RADAR], unit="")
    (tmp_path / "radar.csv").write_text("time_s,file\n0,a.tif\n300,b.tif\n")

    rain = load_case(tmp_path).model.rain

    rows, cols = expected_index()
    assert rain.times.tolist() == [0.0, 300.0]
    assert rain.interpolation == "step"
    np.testing.assert_array_equal(rain.row_index, rows)
    np.testing.assert_array_equal(rain.col_index, cols)
    np.testing.assert_allclose(rain.rates[1] * 3.6e6, 2.0 * RADAR, rtol=1e-6)


def test_the_bands_of_one_file_are_times(tmp_path: Path) -> None:
    write_case(tmp_path, DRY + FILES + 'interpolation = "linear"\nunit = "mm/day"\n')
    write_tiff(tmp_path / "a.tif", [RADAR, 3.0 * RADAR], unit="mm/d")
    (tmp_path / "radar.csv").write_text("time_s,file,band\n-60,a.tif,2\n300,a.tif,1\n")

    rain = load_case(tmp_path).model.rain

    assert rain.interpolation == "linear"
    np.testing.assert_allclose(rain.rates * 8.64e7, [3.0 * RADAR, RADAR], rtol=1e-6)


def test_an_archive_brings_times_and_rasters_in_one(tmp_path: Path) -> None:
    write_case(tmp_path, DRY + '\n[rain]\nseries = "r.npz"\nkey = "p"\nrow0 = "north"\n')
    np.savez(
        tmp_path / "r.npz",
        p=[RADAR[::-1], RADAR[::-1] * 0.0],
        time_s=[0, 60],
        dx=150.0,
        x0=X0 - 30,
        y0=Y0 - 20,
    )

    rain = load_case(tmp_path).model.rain

    np.testing.assert_allclose(rain.rates[0] * 3.6e6, RADAR)
    np.testing.assert_array_equal(rain.row_index, expected_index()[0])


def test_only_the_rain_cells_over_the_terrain_are_kept(tmp_path: Path) -> None:
    write_case(tmp_path, DRY + '\n[rain]\nseries = "r.npz"\n')
    wide = np.zeros((1, 100, 100))
    np.savez(tmp_path / "r.npz", rain=wide, time_s=[0.0], dx=200.0, x0=X0 - 2000.0, y0=Y0 - 2000.0)

    assert load_case(tmp_path).model.rain.rates.shape == (1, 2, 2)


@pytest.mark.parametrize(
    ("table", "message"),
    [
        ("time_s,file\n0,a.tif\n0,b.tif\n", "radar.csv: line 3 is at 0 s, not after 0 s"),
        ("time_s,file\n0,none.tif\n", "radar.csv: line 2 file is 'none.tif', which does not exist"),
        ("time_s,file\n0,../a.tif\n", "line 2 file is '../a.tif'; a relative path"),
        ("time_s,file\n", "radar.csv: has no line of values"),
        ("file,time_s\na.tif,0\n", "line 1 must name the columns, 'time_s'"),
        ("time_s,file,band\n0,a.tif,2\n", "has 1 bands and no band 2"),
        ("time_s,file,band\n0,a.tif,1.5\n", "line 2 has the band 1.5; a whole number"),
        ("time_s,file\n0,a.tif\n9,moved.tif\n", "moved.tif: lies on other cells than a.tif"),
        ("time_s,file\n0,moved.tif\n", r"moved.tif: covers .* not the whole terrain"),
        ("time_s,file\n0,inches.tif\n", "has values in 'in/h'; 'mm/h' is allowed"),
        ("time_s,file\n0,hole.tif\n", r"rain at 0 s is nan mm/h in its cell \(row 1, column 2\)"),
        ("time_s,file\n0,wrong.tif\n", r"is 60000 mm/h in its cell \(row 1, column 2\); 0 to 10000 mm/h"),
        ("time_s,file\n0,case.toml\n", "names the file 'case.toml'; rain in .tif, .asc or .npz"),
    ],
)
def test_bad_rasters_are_told(tmp_path: Path, table: str, message: str) -> None:
    write_case(tmp_path, DRY + FILES)
    write_tiff(tmp_path / "a.tif", [RADAR])
    write_tiff(tmp_path / "moved.tif", [RADAR], x0=X0 + 10.0)
    write_tiff(tmp_path / "inches.tif", [RADAR], unit="in/h")
    hole, wrong = RADAR.copy(), RADAR.copy()
    hole[1, 2], wrong[1, 2] = np.nan, 60_000.0
    write_tiff(tmp_path / "hole.tif", [hole])
    write_tiff(tmp_path / "wrong.tif", [wrong])
    (tmp_path / "b.tif").write_bytes((tmp_path / "a.tif").read_bytes())
    (tmp_path / "radar.csv").write_text(table)

    with pytest.raises(ServiceError, match=message) as caught:
        load_case(tmp_path)

    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"time_s": [0.0, 0.0]}, "'time_s' does not increase"),
        ({"time_s": [0.0, np.nan]}, "'time_s' does not increase"),
        ({"time_s": [0.0]}, r"'rain' has the shape \(2, 2, 3\) and 'time_s' \(1,\)"),
        ({"rain": RADAR}, r"'rain' has the shape \(2, 3\)"),
        ({"dx": -1.0}, "dx, x0, y0 are -1.0"),
        ({"rain": None}, "has no array 'rain', which rain needs"),
    ],
)
def test_a_bad_archive_is_told(tmp_path: Path, change: dict, message: str) -> None:
    write_case(tmp_path, DRY + '\n[rain]\nseries = "r.npz"\n')
    arrays = {"rain": [RADAR, RADAR], "time_s": [0, 60], "dx": 150.0, "x0": X0 - 30, "y0": Y0 - 20} | change
    np.savez(tmp_path / "r.npz", **{name: value for name, value in arrays.items() if value is not None})

    with pytest.raises(ServiceError, match=f"^(case.toml: )?r.npz: {message}"):
        load_case(tmp_path)
