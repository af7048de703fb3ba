"""The state at an edge obeys the invariant of the water that leaves and the condition of its kind."""

import numpy as np
import pytest
import warp as wp

from solver_service.numerics import edge_states as es

G = 9.81
WALL, FALLS = float(es.ACTS_AS_WALL), float(es.FALLS_OFF)


@wp.kernel(enable_backward=False)
def evaluate(
    kind: int,
    h: wp.array(dtype=wp.float32),
    u: wp.array(dtype=wp.float32),
    a: wp.array(dtype=wp.float32),
    b: wp.array(dtype=wp.float32),
    out: wp.array2d(dtype=wp.float32),
):
    k = wp.tid()
    state = es.open_state(h[k], u[k], a[k], b[k])
    if kind == es.EDGE_STAGE:
        state = es.stage_state(h[k], u[k], a[k], b[k])
    if kind == es.EDGE_DISCHARGE:
        state = es.discharge_state(h[k], u[k], a[k])
    if kind == es.EDGE_NORMAL_DEPTH:
        state = es.normal_depth_state(h[k], u[k], a[k], b[k])
    for n in range(3):
        out[k, n] = state[n]


def states(kind, h, u, a, b=0.0):
    """h_b, u_b and the word of every combination, broadcast."""
    arrays = [np.ravel(x).astype(np.float32) for x in np.broadcast_arrays(h, u, a, b)]
    inputs = [wp.array(x, dtype=wp.float32, device="cpu") for x in arrays]
    out = wp.zeros((arrays[0].size, 3), dtype=wp.float32, device="cpu")
    wp.launch(evaluate, dim=arrays[0].size, inputs=[int(kind), *inputs, out], device="cpu")
    assert np.isfinite(out.numpy()).all()
    return [x.astype(np.float64) for x in (*arrays, *out.numpy().T)]


RNG = np.random.default_rng(5)
DEPTH = np.concatenate([[0.0, 1e-35, 1e-6, 1e-3], RNG.uniform(0.0, 6.0, 300)])[:, None]
SPEED = np.concatenate([[0.0], RNG.normal(0.0, 4.0, 60)])[None]


def invariant(h, u):
    return u + 2.0 * np.sqrt(G * h)


@pytest.mark.parametrize(
    ("kind", "a", "b"),
    [
        (es.EDGE_OPEN, 1.5, 0.5),
        (es.EDGE_STAGE, 2.0, 0.0),
        (es.EDGE_DISCHARGE, 3.0, 0.0),
        (es.EDGE_DISCHARGE, -2.0, 0.0),
        (es.EDGE_NORMAL_DEPTH, 9.81 * 0.03**2, 0.002),
    ],
)
def test_subcritical_states_keep_the_outgoing_invariant(kind, a, b):
    h, u, _, _, h_b, u_b, word = states(kind, DEPTH, SPEED, a, b)
    c_b = np.sqrt(G * h_b)
    inside = (abs(u_b) < 0.999 * c_b) & (word != WALL)
    assert inside.sum() > 1000
    assert abs(invariant(h_b, u_b) - invariant(h, u))[inside].max() < 2e-5
    assert (u_b >= -1.00001 * c_b)[word != WALL].all()


def test_what_leaves_faster_than_waves_is_what_is_inside():
    for kind, a, b in ((es.EDGE_OPEN, 1.5, 0.5), (es.EDGE_NORMAL_DEPTH, 0.009, 0.002)):
        h, u, _, _, h_b, u_b, word = states(kind, DEPTH, SPEED, a, b)
        fast = (u > np.sqrt(G * h)) & (h > 0.0)
        assert fast.sum() > 100
        assert (h_b[fast] == h[fast]).all()
        assert (u_b[fast] == u[fast]).all()
        assert (word[fast] == FALLS).all()


def test_an_open_edge_and_a_normal_depth_never_let_water_in():
    for kind, a, b in (
        (es.EDGE_OPEN, 1.5, 0.5),
        (es.EDGE_OPEN, 5.0, 0.0),
        (es.EDGE_NORMAL_DEPTH, 0.009, 0.002),
    ):
        *_, u_b, word = states(kind, DEPTH, SPEED, a, b)
        assert ((u_b >= 0.0) | (word == WALL)).all()


def test_still_water_at_its_level_gives_exactly_itself():
    h = DEPTH[1:]
    *_, h_b, u_b, word = states(es.EDGE_OPEN, h, 0.0, h, 0.0)
    assert (h_b == h.ravel().astype(np.float32)).all()
    assert (u_b == 0.0).all()
    assert (word == 0.0).all()
    rounded = np.nextafter(h.astype(np.float32), np.float32(9.0))
    *_, h_b, u_b, word = states(es.EDGE_STAGE, h, 0.0, rounded)
    assert (h_b == h.ravel().astype(np.float32)).all()
    assert (u_b == 0.0).all()
    assert (word == 0.0).all()


def test_an_open_edge_with_dry_land_beyond_is_a_free_overfall():
    *_, h_b, u_b, word = states(es.EDGE_OPEN, 1.0, 0.0, 0.0)
    assert (word[0], h_b[0]) == (FALLS, pytest.approx(4.0 / 9.0, rel=1e-5))
    assert u_b[0] == pytest.approx(np.sqrt(G * h_b[0]), rel=1e-5)


def test_a_stage_sets_the_depth_and_a_dry_cell_takes_water_at_critical_speed():
    *_, h_b, u_b, word = states(es.EDGE_STAGE, [2.0, 0.0, 2.0, 0.0], 0.0, [2.5, 0.7, -1.0, -1.0])
    assert h_b[:2] == pytest.approx([2.5, 0.7], rel=1e-6)
    assert u_b[1] == pytest.approx(-np.sqrt(G * 0.7), rel=1e-5)
    assert word.tolist() == [0.0, 0.0, FALLS, WALL]


def test_a_stage_above_the_sequent_depth_stops_supercritical_outflow():
    # Froude 2 at 0.5 m: sequent depth 1.19 m
    *_, h_b, _, word = states(es.EDGE_STAGE, 0.5, 2.0 * np.sqrt(G * 0.5), [1.1, 1.3])
    assert word.tolist() == [FALLS, 0.0]
    assert h_b[1] == pytest.approx(1.3, rel=1e-6)


def test_a_discharge_passes_what_is_asked():
    q = np.array([[0.01, 0.5, 3.0, 20.0]]).T
    _, _, asked, _, h_b, u_b, word = states(es.EDGE_DISCHARGE, RNG.uniform(0.0, 6.0, (1, 50)), 0.0, q)
    assert -h_b * u_b == pytest.approx(asked, rel=2e-5)
    assert (word == 0.0).all()
    *_, word = states(es.EDGE_DISCHARGE, 1.0, SPEED, 0.0)
    assert (word == WALL).all()


def test_a_discharge_takes_out_no_more_than_critical_flow():
    *_, h_b, u_b, word = states(es.EDGE_DISCHARGE, [1.0, 1.0, 0.0], 0.0, [-0.5, -9.0, -1.0])
    assert h_b[0] * u_b[0] == pytest.approx(0.5, rel=2e-5)
    assert h_b[1] * u_b[1] == pytest.approx((2.0 / 3.0) ** 3 * np.sqrt(G), rel=2e-5)
    assert word[1:].tolist() == [FALLS, WALL]


def test_a_smooth_bed_has_no_normal_depth_but_a_free_overfall():
    *_, h_b, u_b, word = states(es.EDGE_NORMAL_DEPTH, RNG.uniform(0.05, 6.0, 80), 0.0, 0.0, 0.5)
    assert (word == FALLS).all()
    assert u_b == pytest.approx(np.sqrt(G * h_b), rel=1e-5)


def test_normal_depth_obeys_manning():
    n, slope = 0.03, 0.002
    *_, h_b, u_b, word = states(es.EDGE_NORMAL_DEPTH, RNG.uniform(0.05, 6.0, 80), 0.0, G * n * n, slope)
    assert u_b == pytest.approx(h_b ** (2.0 / 3.0) * np.sqrt(slope) / n, rel=1e-4)
    assert (word == 0.0).all()
