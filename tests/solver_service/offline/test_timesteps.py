from pathlib import Path

import netCDF4
import numpy as np
import pytest
import rasterio
import zarr
from pyproj import CRS

from protocol import GridGeometry
from solver_service.offline.timesteps import NetcdfTimesteps, TimestepFacts, ZarrTimesteps

GRID = GridGeometry(
    nrows=4, ncols=6, dx=10.0, x0=500_000.0, y0=5_400_000.0, crs="EPSG:32632", datum_offset=300.0
)
FACTS = TimestepFacts(
    grid=GRID,
    bed=np.arange(24, dtype=np.float32).reshape(4, 6),
    title="A dam",
    source="made up",
    licence="public domain",
    hypothetical=True,
    start_time="1959-12-02T21:14:00+01:00",
    depth_wet=0.001,
)
FRAMES = [np.full((4, 6), value, np.float32) for value in (0.0, 1.5, 2.5)]
CUT = FACTS.bed - np.float32(0.75)
"""The bed of the later frames."""


def write(writer: NetcdfTimesteps | ZarrTimesteps) -> None:
    for number, h in enumerate(FRAMES):
        writer.append(20.0 * number, h, CUT if number else FACTS.bed)
    writer.close()


def check_levels(level: np.ndarray) -> None:
    assert np.isnan(level[0]).all(), "no water, no level"
    for number in (1, 2):
        np.testing.assert_array_equal(level[number], CUT + FRAMES[number] + 300.0)


def test_a_netcdf_file_holds_depth_bed_axes_and_system(tmp_path: Path) -> None:
    write(NetcdfTimesteps(tmp_path / "t.nc", FACTS))

    with netCDF4.Dataset(tmp_path / "t.nc") as file:
        assert file.Conventions == "CF-1.11"
        np.testing.assert_array_equal(file["depth"][:], np.stack(FRAMES))
        np.testing.assert_array_equal(file["bed"][:], FACTS.bed + 300.0)
        assert file["time"][:].tolist() == [0.0, 20.0, 40.0]
        assert file["time"].units == "seconds since 1959-12-02T21:14:00+01:00"
        assert (file["x"][0], file["y"][-1]) == (500_005.0, 5_400_035.0)
        check_levels(file["level"][:].filled(np.nan))
        assert file["depth"].standard_name == "flood_water_thickness"
        assert CRS.from_wkt(file[file["depth"].grid_mapping].crs_wkt).to_epsg() == 32632
        assert file.comment == "hypothetical"


def test_gdal_opens_the_netcdf_file_with_its_system(tmp_path: Path) -> None:
    writer = NetcdfTimesteps(tmp_path / "t.nc", FACTS)
    writer.append(0.0, FACTS.bed, FACTS.bed)
    writer.close()
    if "netCDF" not in rasterio.drivers.raster_driver_extensions().values():
        pytest.skip("this GDAL has no netCDF driver")

    with rasterio.open(f"netcdf:{tmp_path / 't.nc'}:depth") as image:
        assert image.crs.to_epsg() == 32632
        np.testing.assert_array_equal(image.read(1), FACTS.bed[::-1])


def test_a_zarr_group_holds_the_same(tmp_path: Path) -> None:
    write(ZarrTimesteps(tmp_path / "t.zarr", FACTS))

    group = zarr.open_group(str(tmp_path / "t.zarr"), mode="r")
    assert group.metadata.zarr_format == 3
    np.testing.assert_array_equal(group["depth"][:], np.stack(FRAMES))
    check_levels(group["level"][:])
    np.testing.assert_array_equal(group["time"][:], [0.0, 20.0, 40.0])
    np.testing.assert_array_equal(group["bed"][:], FACTS.bed + 300.0)
    assert group.attrs["hypothetical"] is True
    assert group["depth"].metadata.dimension_names == ("time", "y", "x")


def test_a_case_without_system_or_clock_says_neither(tmp_path: Path) -> None:
    grid = GridGeometry(nrows=4, ncols=6, dx=10.0)
    writer = NetcdfTimesteps(
        tmp_path / "t.nc", TimestepFacts(grid, FACTS.bed, "A dam", "", "", False, None, 1e-3)
    )
    writer.append(0.0, FRAMES[0], FACTS.bed)
    writer.close()

    with netCDF4.Dataset(tmp_path / "t.nc") as file:
        assert "crs" not in file.variables
        assert file["time"].units.startswith("seconds since 1970-01-01")
