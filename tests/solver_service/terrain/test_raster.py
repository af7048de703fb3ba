import numpy as np
import pytest

from protocol.limits import MAX_CELLS
from solver_service.errors import TerrainError
from solver_service.terrain.raster import Raster, check_size, crop, one_mask


def test_nodata_nan_infinities_and_absurd_values_become_one_mask() -> None:
    read = np.array([[1.0, -9999.0, np.nan], [np.inf, -np.inf, 3e38]], np.float32)

    values = one_mask(read, -9999.0)

    assert np.isnan(values).tolist() == [[False, True, True], [True, True, True]]
    assert values[0, 0] == 1.0
    assert values.dtype == np.float32


def test_a_nodata_value_that_is_nan_is_no_special_case() -> None:
    assert np.isnan(one_mask(np.array([[np.nan, 2.0]]), float("nan"))).tolist() == [[True, False]]


@pytest.mark.parametrize(("kind", "result"), [("i2", "f4"), ("i4", "f8"), ("f8", "f8"), ("u1", "f4")])
def test_integers_become_floats_that_hold_them_exactly(kind: str, result: str) -> None:
    largest = np.iinfo(kind).max if kind[0] in "iu" else 1e15 + 1

    values = one_mask(np.array([[largest]], kind), None)

    assert values.dtype == np.dtype(result)
    assert values[0, 0] == largest


def test_cropping_keeps_the_cells_whose_centres_lie_within() -> None:
    raster = Raster(np.arange(20.0).reshape(4, 5), 100.0, 200.0, 10.0, 10.0, "EPSG:32632")

    part = crop(raster, (110.0, 215.0, 140.0, 231.0), "bed.tif")

    assert part.bounds == (110.0, 210.0, 140.0, 230.0)
    assert part.values.tolist() == [[6.0, 7.0, 8.0], [11.0, 12.0, 13.0]]
    assert part.crs == "EPSG:32632"


def test_cropping_to_nothing_names_the_edges() -> None:
    raster = Raster(np.zeros((4, 5)), 100.0, 200.0, 10.0, 10.0)

    with pytest.raises(
        TerrainError, match=r"bounds = .* hold no cell of 'bed.tif'.*100.0, 200.0, 150.0, 240.0"
    ):
        crop(raster, (0.0, 0.0, 50.0, 50.0), "bed.tif")


def test_a_raster_beyond_the_largest_grid_is_refused_before_it_is_read(tmp_path) -> None:
    with pytest.raises(TerrainError, match=f"1 to {MAX_CELLS} cells"):
        check_size(tmp_path / "huge.tif", 100_000, 100_000)
