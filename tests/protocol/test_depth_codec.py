import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from protocol import FrameError, choose_depth_scale, depth_error_bound, dequantise_depth, quantise_depth

scales = st.sampled_from([0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1])
thresholds = st.sampled_from([0.0, 1e-4, 1e-3, 5e-3, 0.01, 0.05])


@given(scales, thresholds, st.integers(0, 2**32 - 1))
def test_the_error_stays_within_the_stated_bound(scale: float, depth_wet: float, seed: int) -> None:
    rng = np.random.default_rng(seed)
    h = np.float32(10.0) ** rng.uniform(-5, math.log10(65535 * scale), 1000).astype(np.float32)
    h[:2] = 0.0, depth_wet
    restored = dequantise_depth(quantise_depth(h, scale, depth_wet), scale)
    error = np.abs(restored.astype(np.float64) - h)
    rounding = 4 * np.finfo(np.float32).eps * h
    assert (error <= depth_error_bound(scale, depth_wet) * (1 + 1e-6) + rounding).all()


@given(scales, thresholds, st.integers(0, 2**32 - 1))
def test_a_cell_is_wet_exactly_from_depth_wet_on(scale: float, depth_wet: float, seed: int) -> None:
    h = np.random.default_rng(seed).uniform(0, 3 * max(scale, depth_wet), 500).astype(np.float32)
    np.testing.assert_array_equal(
        quantise_depth(h, scale, depth_wet) > 0, (h >= np.float32(depth_wet)) & (h >= 0)
    )


def test_depths_are_quantised_as_the_formula_says() -> None:
    h = np.array([0.0, 0.0009, 0.001, 0.0014, 0.0016, 1.0, 65.5344, 65.6, 1e9], dtype=np.float32)
    assert quantise_depth(h, 0.001, 0.001).tolist() == [0, 0, 1, 1, 2, 1000, 65534, 65535, 65535]


def test_halves_are_rounded_to_even() -> None:
    h = np.array([0.5, 1.5, 2.5, 3.5], dtype=np.float32)
    assert quantise_depth(h, 1.0, 0.001).tolist() == [1, 2, 2, 4]


def test_a_thin_wet_cell_stays_wet() -> None:
    assert quantise_depth(np.float32([0.001]), 0.01, 0.001).tolist() == [1]


def test_what_is_not_a_depth_is_dry() -> None:
    assert quantise_depth(np.float32([np.nan, -1.0, -np.inf]), 0.001, 0.001).tolist() == [0, 0, 0]


def test_restored_depths_are_single_precision() -> None:
    restored = dequantise_depth(np.array([[0, 1], [3, 65535]], dtype=np.uint16), 0.002)
    assert restored.dtype == np.float32
    np.testing.assert_array_equal(restored, np.float32([[0, 1], [3, 65535]]) * np.float32(0.002))


@pytest.mark.parametrize(
    ("h_max", "scale"),
    [
        (0.0, 0.001),
        (43.69, 0.001),
        (43.7, 0.002),
        (87.38, 0.002),
        (87.4, 0.005),
        (219.0, 0.01),
        (9000.0, 0.5),
    ],
)
def test_the_finest_scale_with_headroom_is_chosen(h_max: float, scale: float) -> None:
    assert choose_depth_scale(h_max) == scale


@given(st.floats(0, 1e9))
def test_the_chosen_scale_leaves_headroom(h_max: float) -> None:
    assert 1.5 * h_max <= 65535 * choose_depth_scale(h_max)


@pytest.mark.parametrize("h_max", [math.nan, math.inf])
def test_a_largest_depth_that_is_not_finite_is_refused(h_max: float) -> None:
    with pytest.raises(FrameError, match="finite"):
        choose_depth_scale(h_max)
