from pathlib import Path

import numpy as np
import pytest
import rasterio
from rasterio.transform import from_origin

from solver_service.errors import CaseError, ServiceError, TerrainError
from solver_service.scenario import load_case
from tests.solver_service.selafin_file import plane, write_selafin
from tests.solver_service.tiny_case import CASE, COLS, ROWS, valley, write_case


def changed(old: str, new: str) -> str:
    assert old in CASE
    return CASE.replace(old, new)


def write_tiff(
    path: Path, values: np.ndarray, crs: str | None, x0=600_000.0, ytop=5_500_000.0, dx=10.0
) -> None:
    with rasterio.open(
        path,
        "w",
        driver="GTiff",
        height=values.shape[0],
        width=values.shape[1],
        count=1,
        dtype="float32",
        crs=crs,
        transform=from_origin(x0, ytop, dx, dx),
    ) as file:
        file.write(values[::-1].astype(np.float32), 1)


FLAT = "[[initial.level]]\nlevel = 306.0\neverywhere_below = true"
POOL = CASE[CASE.index("[[initial.level]]") : CASE.index("[[boundary]]")]


def tiff_case(folder: Path, crs_line: str, crs: str | None, **position) -> Path:
    text = changed('dem = "bed.npz"\nkey = "bed"', 'dem = "bed.tif"').replace('crs = "local"\n', crs_line)
    write_case(folder, text.replace(POOL, FLAT + "\n"))
    write_tiff(folder / "bed.tif", valley(), crs, **position)
    return folder


def test_the_bed_is_stored_from_its_offset_with_row_0_south(tmp_path: Path) -> None:
    case = load_case(write_case(tmp_path))

    assert case.grid.shape == (ROWS, COLS)
    assert case.grid.datum_offset == 300.0
    np.testing.assert_allclose(case.z_b + 300.0, valley(), atol=1e-4)


def test_row0_north_turns_the_array(tmp_path: Path) -> None:
    tilted = valley() + np.linspace(0.0, 5.0, ROWS, dtype=np.float32)[:, None]
    south = load_case(write_case(tmp_path / "south", bed=tilted))
    north = load_case(
        write_case(tmp_path / "north", changed('key = "bed"', 'row0 = "north"'), bed=tilted[::-1])
    )

    np.testing.assert_array_equal(south.z_b, north.z_b)


def test_the_cell_size_asked_for_wins_over_the_case(tmp_path: Path) -> None:
    write_case(tmp_path, changed('key = "bed"', "cell_size = 10.0"))

    case = load_case(tmp_path, cell_size=20.0)

    assert (case.grid.nrows, case.grid.ncols, case.grid.dx) == (ROWS // 2, COLS // 2, 20.0)
    np.testing.assert_allclose(
        case.z_b + case.grid.datum_offset, valley().reshape(12, 2, 20, 2).mean(axis=(1, 3)), atol=1e-3
    )


def test_a_mesh_is_interpolated_at_the_cell_size(tmp_path: Path) -> None:
    text = changed('dem = "bed.npz"\nkey = "bed"', 'dem = "m.slf"\ncell_size = 5.0').replace(POOL, "")
    write_case(tmp_path, text)
    write_selafin(tmp_path / "m.slf")

    case = load_case(tmp_path)

    assert case.grid.shape == (12, 20)
    x, y = case.grid.center(3, 7)
    assert case.z_b[3, 7] == pytest.approx(plane(x, y), abs=1e-4)


def test_the_system_of_the_file_is_taken_where_the_case_names_none(tmp_path: Path) -> None:
    case = load_case(tiff_case(tmp_path, "", "EPSG:32632"))

    assert case.grid.crs == "EPSG:32632"


def test_another_system_than_that_of_the_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(
        CaseError, match=r"\[case\] crs is 'EPSG:32633', but \[terrain\] dem 'bed.tif' is in 'EPSG:32632'"
    ):
        load_case(tiff_case(tmp_path, 'crs = "EPSG:32633"\n', "EPSG:32632"))


def test_no_system_anywhere_is_refused(tmp_path: Path) -> None:
    with pytest.raises(CaseError, match=r"\[case\] crs is missing and the terrain file names none"):
        load_case(tiff_case(tmp_path, "", None))


def test_degrees_are_refused_with_the_zone_and_taken_when_reprojected(tmp_path: Path) -> None:
    degrees = {"x0": 11.0, "ytop": 49.5, "dx": 1.0 / 1200.0}
    tiff_case(tmp_path, "", "EPSG:4326", **degrees)

    with pytest.raises(TerrainError, match=r"'bed.tif' .*in degrees.*UTM zone 32N, EPSG:32632.*reproject"):
        load_case(tmp_path)

    text = (tmp_path / "case.toml").read_text()
    (tmp_path / "case.toml").write_text(
        text.replace('dem = "bed.tif"', 'dem = "bed.tif"\nreproject = "EPSG:32632"\ncell_size = 50.0')
    )
    case = load_case(tmp_path)
    assert case.grid.crs == "EPSG:32632"
    assert case.grid.dx == 50.0
    assert case.grid.x0 == pytest.approx(644_750.0, abs=2000.0)


def test_a_case_in_degrees_is_refused(tmp_path: Path) -> None:
    with pytest.raises(TerrainError, match=r"case.toml: \[case\] crs 'EPSG:4326' is in degrees"):
        load_case(write_case(tmp_path, changed('"local"', '"EPSG:4326"')))


def test_nan_infinite_and_nodata_cells_are_walls(tmp_path: Path) -> None:
    bed = valley()
    bed[3, 30], bed[4, 31], bed[5, 32] = np.nan, np.inf, -9999.0

    case = load_case(write_case(tmp_path, changed('key = "bed"', "nodata_value = -9999.0"), bed=bed))

    assert np.argwhere(case.model.blocked).tolist() == [[3, 30], [4, 31], [5, 32]]
    assert case.nodata_count == 3
    assert np.isfinite(case.z_b).all()
    assert case.grid.datum_offset == 300.0


def test_holes_can_be_filled(tmp_path: Path) -> None:
    bed = valley()
    bed[3:5, 30] = np.nan

    case = load_case(write_case(tmp_path, changed('key = "bed"', 'nodata = "fill"'), bed=bed))

    assert case.model.blocked is None
    assert case.nodata_count == 2


def test_houses_are_raised(tmp_path: Path) -> None:
    text = CASE + '\n[[terrain.raise]]\npolygons = "houses.csv"\nby = 3.0\n'
    write_case(tmp_path, text)
    (tmp_path / "houses.csv").write_text("1200,2100\n1220,2100\n1220,2120\n1200,2120\n")

    case = load_case(tmp_path)

    raised = case.z_b + case.grid.datum_offset - valley()
    assert np.argwhere(raised > 2.9).tolist() == [[10, 20], [10, 21], [11, 20], [11, 21]]
    assert np.abs(raised[raised < 2.9]).max() < 1e-4


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            "manning_n = 0.03",
            "manning_n = -0.03",
            r"\[roughness\] manning_n is -0.03; a Manning roughness from 0 to 1",
        ),
        ("manning_n = 0.03", "manning_n = 30.0", r"manning_n is 30.0"),
        (
            "manning_n = 0.03",
            'raster = "n.npz"',
            r"raster is 'n.npz'; its cell \(row 0, column 0\) holds -1; a Manning",
        ),
        ("manning_n = 0.03", "", r"\[roughness\] has no value; one of manning_n, raster, classes"),
        ('dem = "bed.npz"', 'dem = "bad.tif"', r"dem is 'bad.tif', which does not exist"),
        ('dem = "bed.npz"', "dem = 5", r"\[terrain\] dem is 5; a text"),
        ('key = "bed"', 'key = "beds"', r"no array 'beds'"),
        ('key = "bed"', "cell_size = -5.0", r"cell_size is -5.0; a cell size in m"),
        (
            'key = "bed"',
            "bounds = [5, 5, 4, 6]",
            r"bounds is \[5, 5, 4, 6\]; \[xmin, ymin, xmax, ymax\] with xmin < xmax",
        ),
        ('key = "bed"', "bounds = [5, 5, 6, 6]", r"hold no cell of 'bed.npz'"),
        ('key = "bed"', 'nodata = "zero"', r"nodata is 'zero'; 'wall', 'fill' is allowed"),
        ('key = "bed"', 'reproject = "EPSG:32632"', r"reproject is .*allowed"),
    ],
)
def test_bad_ground_is_told_in_one_sentence(tmp_path: Path, old: str, new: str, message: str) -> None:
    write_case(tmp_path, changed(old, new))
    np.savez(tmp_path / "n.npz", manning_n=np.full((ROWS, COLS), -1.0))

    with pytest.raises(ServiceError, match=message) as caught:
        load_case(tmp_path)

    assert "\n" not in str(caught.value)
    assert str(caught.value).startswith("case.toml")


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ("by = 3.0", "either 'polygons' .* or 'polygon'"),
        ("by = 3.0\npolygon = [[0, 0], [1, 1], [1, 0]]", "covers no cell of the terrain"),
        ("by = 3.0\npolygon = [[0, 0], [1, 1], [0, 0]]", "2 different corners"),
        ("by = 1e9\npolygon = [[0, 0], [1, 1], [1, 0]]", "by is 1000000000.0; a height in m"),
    ],
)
def test_bad_houses_are_told(tmp_path: Path, keys: str, message: str) -> None:
    with pytest.raises(CaseError, match=message):
        load_case(write_case(tmp_path, f"{CASE}\n[[terrain.raise]]\n{keys}\n"))
