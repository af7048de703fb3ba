from pathlib import Path

import numpy as np
import rasterio

from protocol import GridGeometry
from solver_service.offline.maps import write_map
from solver_service.terrain import read_dem


def test_a_map_opens_north_up_with_system_unit_and_no_value(tmp_path: Path) -> None:
    grid = GridGeometry(nrows=2, ncols=3, dx=10.0, x0=500.0, y0=800.0, crs="EPSG:32632")
    values = np.array([[1.0, np.nan, 3.0], [4.0, 5.0, 6.0]], np.float32)

    write_map(tmp_path / "h.tif", values, grid, "m", "largest depth")

    with rasterio.open(tmp_path / "h.tif") as image:
        np.testing.assert_array_equal(image.read(1), values[::-1])
        assert image.crs.to_epsg() == 32632
        assert tuple(image.bounds) == (500.0, 800.0, 530.0, 820.0)
        assert np.isnan(image.nodata)
        assert image.units == ("m",)
        assert image.descriptions == ("largest depth",)


def test_a_map_reads_back_as_it_was_written(tmp_path: Path, rng: np.random.Generator) -> None:
    grid = GridGeometry(nrows=70, ncols=33, dx=2.5, x0=-7.0, y0=3.0)
    values = rng.random(grid.shape, dtype=np.float32)

    write_map(tmp_path / "h.tif", values, grid, "m", "depth")

    raster = read_dem(tmp_path / "h.tif")
    np.testing.assert_array_equal(raster.values, values)
    assert raster.bounds == grid.extent
    assert raster.crs is None
