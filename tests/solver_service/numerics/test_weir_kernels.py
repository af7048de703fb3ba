"""The flux over one wall, against its formula and its symmetries."""

import numpy as np
import pytest
import warp as wp

from solver_service.numerics.reconstruction import prediction
from solver_service.numerics.weir_kernels import side_state, weir_flux

DT_DX = 0.02


@wp.kernel(module="unique", enable_backward=False)
def flux_of(states: wp.array2d(dtype=wp.float32), dt_dx: float, flux: wp.array(dtype=wp.vec4)):
    k = wp.tid()
    left = prediction()
    right = prediction()
    left[0] = states[k, 0]
    left[1] = states[k, 1]
    left[2] = states[k, 2]
    left[11] = wp.sqrt(9.81 * states[k, 0])
    left[12] = 1.0
    right[0] = states[k, 3]
    right[1] = states[k, 4]
    right[2] = states[k, 5]
    right[11] = wp.sqrt(9.81 * states[k, 3])
    right[12] = 1.0
    l = side_state(left, left[0], left[1], left[2], True, 1.0, False)
    r = side_state(right, right[0], right[1], right[2], True, -1.0, False)
    flux[k] = weir_flux(l, r, states[k, 6], states[k, 7], states[k, 7] - states[k, 6], 1.7, dt_dx)


def fluxes(rows):
    """Mass [m2/s], normal momentum left and right, tangential; rows of h u v, h u v, bed step, crest."""
    states = np.array(rows, np.float32)
    flux = wp.zeros(len(states), dtype=wp.vec4, device="cpu")
    inputs = [wp.array(states, dtype=wp.float32, device="cpu"), DT_DX]
    wp.launch(flux_of, dim=len(states), inputs=inputs, outputs=[flux], device="cpu")
    result = flux.numpy().astype(float)
    result[:, 0] /= DT_DX
    return result


def test_still_water_below_the_crest_feels_nothing_at_all():
    rows = [(2.0, 0, 0, 0.7, 0, 0, 0.3, 2.5), (1.3, 0, 0, 0.0, 0, 0, -4.0, 1.3), (0, 0, 0, 0, 0, 0, 0, 1.0)]
    assert not fluxes(rows).any()


def test_level_water_above_the_crest_feels_nothing_at_all():
    rows = [(2.0, 0, 0, 1.7, 0, 0, 0.3, 1.0), (3.1, 0, 0, 3.1, 0, 0, 0.0, 0.2)]
    assert not fluxes(rows).any()


@pytest.mark.parametrize("down", [0.0, 1.9, 2.2, 2.4])
def test_water_that_has_come_up_to_speed_passes_by_poleni_and_villemonte(down):
    head, tail = 0.6, max(down - 2.0, 0.0)
    expected = 1.7 * head**1.5 * (1.0 - (tail / head) ** 1.5) ** 0.385
    u = expected / 2.6
    ((mass, left, right, along),) = fluxes(
        [(2.6, u, 0.5, down, expected / max(down, 1e-9) if down else 0, 0, 0, 2.0)]
    )
    assert mass == pytest.approx(expected, rel=1e-4)
    assert left == pytest.approx(mass * u, rel=1e-3), "no force on water that all passes"
    assert along == pytest.approx(mass * 0.5, rel=1e-5)
    assert right > 0.0


def test_from_rest_nearly_equal_levels_exchange_no_more_than_their_riemann_flux():
    ((mass, *_),) = fluxes([(3.0, 0, 0, 2.99, 0, 0, 0, 2.0)])
    assert mass == pytest.approx(0.5 * np.sqrt(9.81 * 1.0) * 0.01, rel=0.02)
    assert mass < 0.1 * 1.7 * (1.0 - 0.99**1.5) ** 0.385, "the weir formula alone would make them swing"


def test_a_wall_throws_back_what_runs_into_it():
    ((mass, left, right, _),) = fluxes([(1.0, 2.0, 0, 0.0, 0, 0, 0, 9.0)])
    shelf = np.sqrt(9.81)
    assert mass == 0.0
    assert left == pytest.approx(2.0 * 2.0 + 2.0 * shelf, rel=0.3)
    assert left > 2.0 * shelf
    assert right == 0.0


def test_walls_mirror_bit_for_bit(rng):
    count = 400
    h_l, h_r = rng.uniform(0.0, 3.0, (2, count)) * (rng.random((2, count)) < 0.9)
    u_l, u_r, v_l, v_r = rng.normal(0.0, 1.5, (4, count))
    step = rng.uniform(-1.0, 1.0, count)
    step = np.float32(step)
    crest = np.float32(rng.uniform(-0.5, 3.0, count))
    there = fluxes(np.stack([h_l, u_l, v_l, h_r, u_r, v_r, step, crest], axis=1))
    back = fluxes(np.stack([h_r, -u_r, v_r, h_l, -u_l, v_l, -step, crest - step], axis=1))
    # The crest is given over the left bed: its height over the right one is rounded by the mirrored input.
    assert np.allclose(there[:, 0], -back[:, 0], atol=2e-5)
    assert np.allclose(there[:, 1], back[:, 2], atol=2e-4)
    assert np.allclose(there[:, 3], -back[:, 3], atol=2e-4)
    level = step == 0.0
    assert not level.any()
    flat = np.zeros_like(step)
    there = fluxes(np.stack([h_l, u_l, v_l, h_r, u_r, v_r, flat, crest], axis=1))
    back = fluxes(np.stack([h_r, -u_r, v_r, h_l, -u_l, v_l, flat, crest], axis=1))
    assert np.array_equal(there[:, 0], -back[:, 0])
    assert np.array_equal(there[:, 1], back[:, 2])


def test_a_buried_wall_passes_what_passes_without_it():
    ((mass, left, right, _),) = fluxes([(2.0, 0.7, 0, 2.0, 0.7, 0, 0, -0.5)])
    assert mass == pytest.approx(1.4, rel=1e-5)
    assert left == pytest.approx(1.4 * 0.7, rel=1e-4)
    assert right == pytest.approx(left, rel=1e-4)
