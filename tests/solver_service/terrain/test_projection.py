import numpy as np
import pytest
from scipy import ndimage

from solver_service.errors import TerrainError
from solver_service.terrain.projection import (
    centre_of,
    check_metres,
    is_geographic,
    reproject,
    same_crs,
    utm_zone,
)
from solver_service.terrain.raster import Raster


@pytest.mark.parametrize(
    ("place", "zone"),
    [
        ((11.5, 49.5), "UTM zone 32N, EPSG:32632"),
        ((-71.5, -28.5), "UTM zone 19S, EPSG:32719"),
        ((180.0, 10.0), "UTM zone 60N, EPSG:32660"),
    ],
)
def test_the_utm_zone_of_a_place_is_named(place: tuple[float, float], zone: str) -> None:
    assert utm_zone(*place) == zone


def test_degrees_are_refused_with_the_zone_to_use() -> None:
    with pytest.raises(
        TerrainError, match=r"case.toml: crs 'EPSG:4326' is in degrees.*UTM zone 32N, EPSG:32632"
    ):
        check_metres("EPSG:4326", "case.toml: crs", (11.5, 49.5))


def test_feet_are_refused() -> None:
    with pytest.raises(TerrainError, match=r"is in US survey foot; metres are allowed"):
        check_metres("EPSG:2225", "case.toml: crs")


def test_nonsense_is_no_system() -> None:
    with pytest.raises(TerrainError, match=r"'UTM of my town' is no coordinate system that PROJ knows"):
        check_metres("UTM of my town", "case.toml: crs")


def test_metres_and_local_are_taken() -> None:
    check_metres("EPSG:32632", "crs")
    check_metres("local", "crs")


def test_two_names_of_one_system_are_the_same() -> None:
    from pyproj import CRS

    assert same_crs("EPSG:32632", CRS.from_epsg(32632).to_wkt(), "crs")
    assert not same_crs("EPSG:32632", "EPSG:32633", "crs")
    assert not same_crs("local", "EPSG:32633", "crs")


def test_only_degrees_are_geographic() -> None:
    assert is_geographic("EPSG:4326", "crs")
    assert not is_geographic("EPSG:32632", "crs")
    assert not is_geographic("local", "crs")
    assert not is_geographic(None, "crs")


def degrees(values: np.ndarray) -> Raster:
    return Raster(values, 11.0, 49.0, 1.0 / 1200.0, 1.0 / 1200.0, "EPSG:4326")


def test_a_tilted_plane_in_degrees_stays_a_plane_in_metres() -> None:
    from pyproj import Transformer

    raster = degrees((400.0 + np.arange(80.0)[:, None] + 0.5 * np.arange(90.0)[None, :]).astype(np.float32))

    projected = reproject(raster, "EPSG:32632", 60.0, "case.toml: [terrain] reproject")

    rows, cols = projected.shape
    assert (projected.dx, projected.dy) == (60.0, 60.0)
    x, y = np.meshgrid(
        projected.x0 + (np.arange(cols) + 0.5) * 60.0, projected.y0 + (np.arange(rows) + 0.5) * 60.0
    )
    lon, lat = Transformer.from_crs("EPSG:32632", "EPSG:4326", always_xy=True).transform(x, y)
    expected = 400.0 + ((lat - 49.0) * 1200.0 - 0.5) + 0.5 * ((lon - 11.0) * 1200.0 - 0.5)
    inner = ndimage.binary_erosion(~projected.void, iterations=4)
    assert inner.sum() > 0.7 * rows * cols
    np.testing.assert_allclose(projected.values[inner], expected[inner], atol=0.15)


def test_holes_stay_holes_when_reprojected() -> None:
    values = np.full((60, 60), 300.0, np.float32)
    values[20:40, 20:40] = np.nan

    projected = reproject(degrees(values), "EPSG:32632", None, "reproject")

    middle = tuple(side // 2 for side in projected.shape)
    assert np.isnan(projected.values[middle])
    np.testing.assert_allclose(projected.values[~projected.void], 300.0, atol=1e-3)


def test_reprojecting_to_degrees_or_to_too_many_cells_is_refused() -> None:
    raster = degrees(np.zeros((20, 20), np.float32))

    with pytest.raises(TerrainError, match="is in degrees"):
        reproject(raster, "EPSG:4258", None, "reproject")
    with pytest.raises(TerrainError, match="cells; up to"):
        reproject(raster, "EPSG:32632", 0.01, "reproject")


def test_the_centre_is_half_way_between_the_edges() -> None:
    assert centre_of(Raster(np.zeros((2, 4)), 10.0, 20.0, 1.0, 2.0)) == (12.0, 22.0)
