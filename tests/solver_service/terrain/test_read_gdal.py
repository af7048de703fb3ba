from pathlib import Path

import numpy as np
import pytest
import rasterio
from rasterio.transform import Affine, from_origin

from solver_service.errors import TerrainError
from solver_service.terrain.read_gdal import read_erdas, read_geotiff, read_usgs_dem

NORTH_FIRST = np.array([[5.0, 6.0, 7.0], [1.0, -9999.0, 3.0]], np.float32)


def write_tiff(path: Path, values: np.ndarray = NORTH_FIRST, **options) -> Path:
    profile = {
        "driver": "GTiff",
        "height": values.shape[-2],
        "width": values.shape[-1],
        "count": 1 if values.ndim == 2 else values.shape[0],
        "dtype": values.dtype,
        "crs": "EPSG:32632",
        "transform": from_origin(500.0, 820.0, 10.0, 10.0),
        "nodata": -9999.0,
    } | options
    unit = profile.pop("unit", None)
    with rasterio.open(path, "w", **profile) as file:
        file.write(values if values.ndim == 3 else values[None])
        if unit:
            file.units = (unit,)
    return path


def test_a_geotiff_is_turned_so_that_row_0_is_south(tmp_path: Path) -> None:
    raster = read_geotiff(write_tiff(tmp_path / "bed.tif"))

    np.testing.assert_array_equal(raster.values, [[1.0, np.nan, 3.0], [5.0, 6.0, 7.0]])
    assert raster.bounds == (500.0, 800.0, 530.0, 820.0)
    assert "32632" in str(raster.crs)


def test_an_erdas_raster_is_read(tmp_path: Path) -> None:
    raster = read_erdas(write_tiff(tmp_path / "bed.img", driver="HFA"))

    assert raster.shape == (2, 3)
    assert raster.values[1, 0] == 5.0


def test_a_usgs_dem_of_mount_st_helens_is_read() -> None:
    import os

    path = Path(os.environ.get("FEV_DATA_HOME", "")) / "terrain" / "sthelens" / "SainteHelens.dem"
    if not path.is_file():
        pytest.skip("SainteHelens.dem of FEV_DATA_HOME is not there")

    raster = read_usgs_dem(path)

    assert raster.shape == (468, 327)
    assert (raster.dx, raster.dy) == (30.0, 30.0)
    assert np.nanmax(raster.values) == 2543.0


@pytest.mark.parametrize("reader", [read_geotiff, read_usgs_dem, read_erdas])
def test_a_file_that_makes_gdal_read_another_is_refused(tmp_path: Path, reader) -> None:
    secret = write_tiff(tmp_path / "secret.tif")
    trap = tmp_path / "trap"
    trap.write_text(
        '<VRTDataset rasterXSize="3" rasterYSize="2"><VRTRasterBand dataType="Float32"'
        ' band="1"><SimpleSource>'
        f'<SourceFilename relativeToVRT="0">{secret}</SourceFilename><SourceBand>1</SourceBand>'
        "</SimpleSource></VRTRasterBand></VRTDataset>"
    )

    with pytest.raises(TerrainError, match="'trap'"):
        reader(trap)


def test_a_truncated_tiff_is_refused(tmp_path: Path) -> None:
    path = write_tiff(tmp_path / "bed.tif", np.zeros((200, 200), np.float32))
    path.write_bytes(path.read_bytes()[:1000])

    with pytest.raises(TerrainError, match=r"'bed.tif' cannot be read as GTiff"):
        read_geotiff(path)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"unit": "ft"}, "values in 'ft'; metres are allowed"),
        ({"transform": Affine(10.0, 1.0, 500.0, 1.0, -10.0, 820.0)}, "is turned"),
        ({"transform": Affine(10.0, 0.0, 500.0, 0.0, 10.0, 800.0)}, "north to south are allowed"),
    ],
)
def test_a_raster_that_is_not_upright_metres_is_refused(tmp_path: Path, options, message: str) -> None:
    with pytest.raises(TerrainError, match=message):
        read_geotiff(write_tiff(tmp_path / "bed.tif", **options))


def test_a_picture_is_no_terrain(tmp_path: Path) -> None:
    with pytest.raises(TerrainError, match="has 3 bands; one band is allowed"):
        read_geotiff(write_tiff(tmp_path / "ortho.tif", np.zeros((3, 4, 5), np.float32)))


def test_one_of_several_bands_is_read_by_its_number_and_unit(tmp_path: Path) -> None:
    path = tmp_path / "rain.tif"
    place = rasterio.transform.from_origin(0.0, 30.0, 10.0, 10.0)
    with rasterio.open(
        path, "w", driver="GTiff", height=3, width=2, count=2, dtype="float32", transform=place
    ) as file:
        for band in (1, 2):
            file.write(np.full((3, 2), 10.0 * band, np.float32), band)
        file.units = ("mm/h", "mm/h")

    assert (read_geotiff(path, 2, ("", "mm/h")).values == 20.0).all()
    with pytest.raises(TerrainError, match=r"has 2 bands and no band 3"):
        read_geotiff(path, 3, ("", "mm/h"))
    with pytest.raises(TerrainError, match=r"has values in 'mm/h'; metres are allowed"):
        read_geotiff(path, 1)
    with pytest.raises(TerrainError, match=r"has values in 'mm/h'; 'm/s' is allowed"):
        read_geotiff(path, 1, ("", "m/s"))
