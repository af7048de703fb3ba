"""Taking and giving water in whole quanta, and reading ratings, one launch at a time."""

import numpy as np
import pytest
import warp as wp

from solver_service.numerics.clock_kernels import CLOCK_LENGTH, CLOCK_TIME
from solver_service.numerics.conduit_kernels import (
    CARRIED,
    DISCHARGE,
    DUE,
    MOVED,
    NUMBER_COUNT,
    RUNNING,
    STATE_COUNT,
    run_conduits,
)

AREA = 25.0


def pump(depths, outlets, rating=((0.0,), (1.0,)), dt=1.0, state=None, velocity=0.3):
    """Run one pump for one step; returns depths, velocities and its state.

    The cells of `depths` lie in a row; the last `outlets` of them are outlets.
    """
    count = len(depths)
    fields = [
        wp.array(np.array([values], np.float32), dtype=wp.float32, device="cpu")
        for values in (depths, np.full(count, velocity), np.full(count, -velocity))
    ]
    clock = np.zeros(CLOCK_LENGTH)
    clock[int(CLOCK_TIME)] = dt
    numbers = np.zeros((1, NUMBER_COUNT))
    numbers[0, 0] = 1.0
    numbers[0, 10:12] = -np.inf
    states = wp.array(np.zeros((1, STATE_COUNT)) if state is None else state, dtype=wp.float64, device="cpu")
    cells = np.stack([np.zeros(count), np.arange(count)], axis=1)
    wp.launch(
        run_conduits,
        dim=1,
        inputs=[
            wp.array(clock, dtype=wp.float64, device="cpu"),
            wp.array([0, 1], dtype=wp.int32, device="cpu"),
            wp.array(numbers, dtype=wp.float64, device="cpu"),
            wp.array([[0, count - outlets, count]], dtype=wp.int32, device="cpu"),
            wp.array(cells, dtype=wp.int32, device="cpu"),
            wp.array([0, len(rating[0])], dtype=wp.int32, device="cpu"),
            wp.array(rating[0], dtype=wp.float64, device="cpu"),
            wp.array(rating[1], dtype=wp.float64, device="cpu"),
            AREA,
            1e-3,
            wp.zeros((1, count), dtype=wp.float32, device="cpu"),
        ],
        outputs=[*fields, states],
        device="cpu",
    )
    return fields[0].numpy()[0], fields[1].numpy()[0], states.numpy()


def test_what_one_end_loses_the_other_gets_and_the_rest_is_carried():
    before = np.array([1.7, 0.9, 0.3, 41.123456], np.float32)
    after, _, state = pump(before, 2, ((0.0,), (7.0,)))
    lost = (before[:2].astype(float) - after[:2]).sum() * AREA
    got = (after[2:].astype(float) - before[2:]).sum() * AREA
    assert lost == state[0, int(MOVED)]
    assert lost == pytest.approx(7.0, abs=2 * AREA * 2.0**-16)
    assert lost - got == pytest.approx(state[0, int(CARRIED)], abs=1e-13)
    assert abs(state[0, int(CARRIED)]) < 2 * AREA * 2.0**-16


def test_cells_give_in_proportion_to_what_they_hold():
    before = np.array([1.5, 0.5, 0.0], np.float32)
    after, _, _ = pump(before, 1, ((0.0,), (10.0,)))
    given = before[:2] - after[:2]
    assert given[0] / given[1] == pytest.approx(3.0, rel=1e-3)


def test_velocities_stay_where_water_is_taken_and_dilute_where_it_is_given():
    after, u, _ = pump(np.array([1.0, 1.0], np.float32), 1, ((0.0,), (5.0,)))
    assert u[0] == np.float32(0.3)
    assert u[1] == pytest.approx(0.3 * 1.0 / after[1], rel=1e-6)


def test_a_drop_waits_until_it_makes_a_quantum():
    tiny = 0.4 * AREA * 2.0**-16
    depth = np.array([3.0, 0.0], np.float32)
    after, _, state = pump(depth, 1, ((0.0,), (tiny,)))
    assert np.array_equal(after, depth)
    assert state[0, int(DUE)] == pytest.approx(tiny)
    for _ in range(2):
        after, _, state = pump(after, 1, ((0.0,), (tiny,)), state=state)
    assert after[0] == 3.0 - 2.0**-16
    assert after[1] == 2.0**-16


@pytest.mark.parametrize("depth", [0.0, 3e-6, 1e-3, 0.2])
def test_a_thirsty_pump_takes_at_most_half(depth):
    after, u, state = pump(np.array([depth, 0.0], np.float32), 1, ((0.0,), (1e6,)))
    assert 0.5 * depth <= after[0] <= depth
    assert after[0] == pytest.approx(0.5 * depth, abs=2.0**-16)
    if after[0] <= 1e-3:
        assert after[0] == np.float32(depth) or u[0] == 0.0
    assert state[0, int(RUNNING)] == 1.0


@pytest.mark.parametrize(("level", "expected"), [(0.1, 1.0), (1.0, 1.0), (1.5, 2.0), (2.5, 2.0), (9.0, 1.0)])
def test_ratings_are_linear_inside_and_held_outside(level, expected):
    rating = ((1.0, 2.0, 3.0), (1.0, 3.0, 1.0))
    _, _, state = pump(np.array([level, 0.0], np.float32), 1, rating)
    assert state[0, int(DISCHARGE)] == pytest.approx(expected, rel=1e-6)


def test_a_step_of_no_length_changes_nothing():
    depth = np.array([2.0, 0.0], np.float32)
    after, _, state = pump(depth, 1, dt=0.0)
    assert np.array_equal(after, depth)
    assert not state.any()
