import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from solver_service.terrain.raster import Raster
from solver_service.terrain.resample import axis_weights, resample, sample


def raster(values: np.ndarray, dx: float = 10.0) -> Raster:
    return Raster(np.asarray(values, np.float64), 100.0, 200.0, dx, dx)


def test_the_same_cell_size_changes_nothing() -> None:
    source = raster(np.arange(12.0).reshape(3, 4))

    assert resample(source, 10.0) is source


def test_coarser_cells_hold_means_and_keep_the_volume() -> None:
    coarse = resample(raster(np.arange(24.0).reshape(4, 6)), 20.0)

    np.testing.assert_allclose(coarse.values, [[3.5, 5.5, 7.5], [15.5, 17.5, 19.5]])


@given(cell_size=st.floats(10.5, 45.0))
def test_means_over_any_coarser_cells_keep_the_volume(cell_size: float) -> None:
    profile = np.cumsum(np.sin(np.arange(40.0)))
    volume_west_of = np.concatenate([[0.0], np.cumsum(profile) * 10.0])

    coarse = resample(raster(np.tile(profile, (9, 1))), cell_size)

    edges = np.arange(coarse.shape[1] + 1) * cell_size
    expected = np.diff(np.interp(edges, np.arange(41) * 10.0, volume_west_of)) / cell_size
    np.testing.assert_allclose(coarse.values, np.tile(expected, (coarse.shape[0], 1)), atol=1e-9)


def test_finer_cells_follow_a_parabola_exactly_inside() -> None:
    rows, cols = np.meshgrid(np.arange(12.0), np.arange(14.0), indexing="ij")
    fine = resample(raster(cols**2 + 0.5 * rows), 5.0)

    x = (np.arange(28) + 0.5) / 2.0 - 0.5
    y = (np.arange(24) + 0.5) / 2.0 - 0.5
    expected = x[None, :] ** 2 + 0.5 * y[:, None]
    np.testing.assert_allclose(fine.values[4:-4, 4:-4], expected[4:-4, 4:-4], atol=1e-9)


@pytest.mark.parametrize("kind", ["average", "linear", "cubic"])
def test_the_weights_of_every_cell_inside_sum_to_one(kind) -> None:
    weights = axis_weights(20, 0.0, 1.0, 7, 2.0, 2.3, kind)

    np.testing.assert_allclose(np.asarray(weights.sum(axis=1)).ravel(), 1.0)


def test_a_hole_does_not_spread_into_means() -> None:
    values = np.full((4, 4), 5.0)
    values[0, 0] = np.nan
    values[2:, 2:] = np.nan

    coarse = resample(raster(values), 20.0)

    np.testing.assert_array_equal(coarse.values, [[5.0, 5.0], [5.0, np.nan]])


def test_a_hole_stays_where_it_is_on_finer_cells() -> None:
    values = np.full((5, 5), 3.0)
    values[2, 2] = np.nan

    fine = resample(raster(values), 5.0)

    assert np.isnan(fine.values[4:6, 4:6]).all()
    assert np.isnan(fine.values).sum() == 4
    np.testing.assert_allclose(fine.values[~np.isnan(fine.values)], 3.0)


def test_sampling_outside_gives_no_data_and_inside_the_cell_that_is_there() -> None:
    source = raster(np.arange(6.0).reshape(2, 3))

    values = sample(source, 90.0, 200.0, 10.0, 2, 3, "nearest")

    np.testing.assert_array_equal(values, [[np.nan, 0.0, 1.0], [np.nan, 3.0, 4.0]])


def test_linear_sampling_between_two_cells_gives_their_mean() -> None:
    source = raster([[0.0, 10.0], [0.0, 10.0]])

    assert sample(source, 105.0, 205.0, 10.0, 1, 1, "linear").tolist() == [[5.0]]
