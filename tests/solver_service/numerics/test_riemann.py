"""What a face moves: whole floats, never more than the donor can pay; streams drag each other along."""

import numpy as np
import pytest
import warp as wp

from solver_service.numerics.riemann import face_flux

COUNT = 20_000


@wp.kernel
def evaluate(states: wp.array2d(dtype=wp.float32), out: wp.array(dtype=wp.vec4)):
    """Depth, normal and tangential velocity, share, mixing of the left, then the right cell; step, dt/dx."""
    k = wp.tid()
    s = states[k]
    out[k] = face_flux(
        s[0], 0.0, s[1], 0.0, s[2], 0.0, 0.0, wp.sqrt(9.81 * s[0]), s[3], s[4],
        s[5], 0.0, s[6], 0.0, s[7], 0.0, 0.0, wp.sqrt(9.81 * s[5]), s[8], s[9],
        s[10], s[11], 1.0,
    )  # fmt: skip


def fluxes(states):
    states = np.asarray(states, np.float32)
    out = wp.zeros(len(states), dtype=wp.vec4, device="cpu")
    given = wp.array(states, dtype=wp.float32, device="cpu")
    wp.launch(evaluate, dim=len(states), inputs=[given], outputs=[out], device="cpu")
    return out.numpy()


def shallow_beside_deep(seed=1):
    """Films on a high bank on the left, deep water below on the right, nothing but films can give."""
    rng = np.random.default_rng(seed)
    states = np.zeros((COUNT, 12), np.float32)
    states[:, 0] = 10.0 ** rng.uniform(-5.0, -1.0, COUNT)
    states[:, 1] = rng.uniform(0.0, 20.0, COUNT)
    states[:, 3] = rng.uniform(0.0, 1.0, COUNT)
    states[:, 5] = 10.0 ** rng.uniform(1.0, 2.5, COUNT)
    states[:, 8] = 1.0
    states[:, 10] = -400.0
    states[:, 11] = 0.01
    return states


def test_a_shallow_donor_never_gives_more_than_its_share():
    states = shallow_beside_deep()
    moved = fluxes(states)[:, 0].astype(np.float64)
    h, u, share, dt_dx = (states[:, k].astype(np.float64) for k in (0, 1, 3, 11))
    allowed = dt_dx * share * h * (u + np.sqrt(9.81 * h))
    assert (moved >= 0.0).all()
    assert (moved <= allowed * (1.0 + 1e-6)).all()
    assert (moved > 0.0).any()
    # To the nearest of the floats that the deep cell can count, some would give more than they may.
    place = np.spacing(2.0 * states[:, 5]).astype(np.float64)
    asked = np.minimum(dt_dx * h * u, allowed)
    assert (np.rint(asked / place) * place > allowed * (1.0 + 1e-6)).any()


def test_what_is_moved_is_a_whole_number_of_places_of_the_deeper_cell():
    states = shallow_beside_deep()
    moved = fluxes(states)[:, 0].astype(np.float64)
    places = moved / np.spacing(states[:, 5]).astype(np.float64)
    np.testing.assert_array_equal(places, np.rint(places))


def passing_streams(mixing):
    """Two streams of the same depth pass each other; the left one is faster."""
    row = [2.0, 0.0, 3.0, 1.0, mixing, 2.0, 0.0, 1.0, 1.0, mixing, 0.0, 0.01]
    return fluxes([row])[0]


def test_streams_that_pass_each_other_exchange_momentum_and_no_water():
    assert passing_streams(0.0).tolist() == [0.0, 0.0, 0.0, 0.0]
    mass, left, right, tangential = passing_streams(0.25)
    assert (mass, left, right) == (0.0, 0.0, 0.0)
    assert tangential == pytest.approx(0.25 * (3.0 - 1.0))


@pytest.mark.parametrize("step", [5.0, -5.0])
def test_streams_on_two_terraces_do_not(step):
    high, low = [0.5, 0.0, 3.0, 1.0, 0.25], [0.5, 0.0, 1.0, 1.0, 0.25]
    row = [*low, *high] if step > 0.0 else [*high, *low]
    with_mixing = fluxes([[*row, step, 0.01]])[0]
    row[4] = row[9] = 0.0
    np.testing.assert_array_equal(with_mixing, fluxes([[*row, step, 0.01]])[0])
