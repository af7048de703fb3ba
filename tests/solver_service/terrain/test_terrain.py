import numpy as np
import pytest

from solver_service.errors import TerrainError
from solver_service.terrain.raster import Raster
from solver_service.terrain.terrain import datum_offset, make_terrain


def raster(values, dy: float = 10.0) -> Raster:
    return Raster(np.asarray(values, np.float64), 100.0, 200.0, 10.0, dy)


def test_high_ground_is_stored_from_an_offset_that_keeps_millimetres() -> None:
    elevation = np.array([[8000.001, 8000.002], [8100.5, 8848.123]])

    terrain = make_terrain(raster(elevation), name="bed", crs="local")

    assert terrain.grid.datum_offset == 8000.0
    assert terrain.z_b.dtype == np.float32
    np.testing.assert_allclose(terrain.z_b.astype(np.float64) + 8000.0, elevation, atol=1e-4)


@pytest.mark.parametrize(
    ("low", "high", "offset"),
    [(0.0, 50.0, 0.0), (-20.0, 101.0, 0.0), (243.0, 257.0, 240.0), (-500.0, -3.0, -500.0)],
)
def test_the_offset_is_zero_near_sea_level_and_else_whole_tens(
    low: float, high: float, offset: float
) -> None:
    assert datum_offset(low, high) == offset


def test_walls_stand_where_there_is_no_data_and_take_the_ground_beside_them() -> None:
    terrain = make_terrain(raster([[1.0, np.nan], [2.0, 3.0]]), name="bed", crs="local", nodata="wall")

    assert terrain.wall.tolist() == [[False, True], [False, False]]
    assert terrain.z_b[0, 1] in (1.0, 3.0)
    assert terrain.nodata_count == 1


def test_walls_take_the_level_that_is_asked_for() -> None:
    terrain = make_terrain(
        raster([[500.0, np.nan], [510.0, 520.0]]), name="bed", crs="local", wall_level=555.0
    )

    assert terrain.z_b[0, 1] + terrain.grid.datum_offset == 555.0


def test_filling_gives_ground_between_that_of_the_rim() -> None:
    values = np.tile(np.linspace(10.0, 30.0, 21), (21, 1))
    holed = values.copy()
    holed[8:13, 8:13] = np.nan

    terrain = make_terrain(raster(holed), name="bed", crs="local", nodata="fill")

    assert not terrain.wall.any()
    assert terrain.nodata_count == 25
    np.testing.assert_allclose(terrain.z_b, values, atol=2.0)
    np.testing.assert_array_equal(terrain.z_b[~np.isnan(holed)], values[~np.isnan(holed)].astype(np.float32))


def test_oblong_cells_and_empty_rasters_are_refused() -> None:
    with pytest.raises(
        TerrainError, match=r"10 m by 12 m; square cells are allowed: give \[terrain\] cell_size"
    ):
        make_terrain(raster([[1.0]], dy=12.0), name="bed", crs="local")
    with pytest.raises(TerrainError, match="no data in any of its 2 cells"):
        make_terrain(raster([[np.nan, np.nan]]), name="bed", crs="local")
