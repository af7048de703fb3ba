"""The cut of a breach and its growth in single steps, against NumPy."""

import numpy as np
import pytest
import warp as wp

from solver_service.numerics.breach_kernels import (
    NOT_STARTED,
    NUMBER_COUNT,
    STATE_COUNT,
    grow_breaches,
    lower_bed,
)
from solver_service.numerics.clock_kernels import CLOCK_BEFORE, CLOCK_LENGTH, CLOCK_TIME

DX = 5.0


def lowered(ground, along, width, level, side_slope, started=0.0):
    """Bed of cells at ways `along` from the middle."""
    count = len(along)
    z = wp.zeros((1, count), dtype=wp.float32, device="cpu")
    numbers = np.zeros((1, NUMBER_COUNT))
    numbers[0, 10] = side_slope
    cells = np.stack([np.zeros(count, np.int32), np.arange(count, dtype=np.int32)], axis=1)
    wp.launch(
        lower_bed,
        dim=count,
        inputs=[
            wp.array(numbers, dtype=wp.float64, device="cpu"),
            wp.array([[started, width, level]], dtype=wp.float64, device="cpu"),
            wp.zeros(count, dtype=wp.int32, device="cpu"),
            wp.array(cells, dtype=wp.int32, device="cpu"),
            wp.array(along, dtype=wp.float64, device="cpu"),
            wp.array(np.full(count, ground, np.float32), dtype=wp.float32, device="cpu"),
            DX,
        ],
        outputs=[z],
        device="cpu",
    )
    return z.numpy()[0]


@pytest.mark.parametrize(
    ("width", "side_slope"), [(0.0, 0.0), (3.0, 0.0), (22.0, 0.0), (0.0, 2.0), (12.0, 3.0)]
)
def test_a_cell_gets_the_mean_of_the_cut_over_its_side(width, side_slope):
    along = np.arange(-30.0, 31.0, 2.5)
    x = along[:, None] + DX * (np.arange(2000) + 0.5)[None, :] / 2000 - 0.5 * DX
    beyond = np.abs(x) - 0.5 * width
    depth = 4.0
    cut = np.where(beyond <= 0.0, depth, np.maximum(depth - beyond / side_slope, 0.0) if side_slope else 0.0)
    expected = 6.0 - cut.mean(axis=1)
    assert lowered(6.0, along, width, 2.0, side_slope) == pytest.approx(expected, abs=4e-3)


def test_ground_below_the_bottom_and_breaches_not_begun_stay():
    along = np.array([0.0, 5.0])
    assert (lowered(1.5, along, 50.0, 2.0, 1.0) == 1.5).all()
    assert (lowered(6.0, along, 50.0, 2.0, 1.0, started=float(NOT_STARTED)) == 6.0).all()


def grown(numbers, state, before, after, depths, depth_dry=1e-3):
    """State of a breach after a step between two probes of these depths over a level bed."""
    h = np.zeros((5, 6), np.float32)
    h[2, 2], h[2, 3] = depths
    clock = np.zeros(CLOCK_LENGTH)
    clock[int(CLOCK_BEFORE)], clock[int(CLOCK_TIME)] = before, after
    states = wp.array(np.array([state]), dtype=wp.float64, device="cpu")
    wp.launch(
        grow_breaches,
        dim=1,
        inputs=[
            wp.array(clock, dtype=wp.float64, device="cpu"),
            wp.array(h, dtype=wp.float32, device="cpu"),
            wp.zeros(h.shape, dtype=wp.float32, device="cpu"),
            wp.array(np.array([numbers]), dtype=wp.float64, device="cpu"),
            wp.array(np.array([[2, 2, 2, 3]]), dtype=wp.int32, device="cpu"),
            depth_dry,
        ],
        outputs=[states],
        device="cpu",
    )
    assert states.shape == (1, STATE_COUNT)
    return states.numpy()[0].tolist()


# start, overtopped, crest, bottom, duration, first and final width, linear, growth, decay, side slope
LINEAR = [10.0, 0.0, 5.0, 1.0, 100.0, 20.0, 60.0, 1.0, 0.0, 0.0, 0.0]
VERHEIJ = [10.0, 0.0, 5.0, 1.0, 100.0, 20.0, 600.0, 0.0, 20.0, 2.0, 0.0]
ASLEEP = [float(NOT_STARTED), 0.0, 5.0]


def test_a_step_of_no_length_changes_nothing():
    assert grown(LINEAR, ASLEEP, 20.0, 20.0, (4.0, 0.0)) == ASLEEP


def test_a_breach_begins_at_its_time_wherever_the_step_ends():
    assert grown(LINEAR, ASLEEP, 5.0, 9.0, (4.0, 0.0)) == ASLEEP
    assert grown(LINEAR, ASLEEP, 5.0, 35.0, (4.0, 0.0)) == [10.0, 30.0, 4.0]


def test_only_water_above_the_crest_overtops():
    numbers = [10.0, 1.0, *LINEAR[2:]]
    assert grown(numbers, ASLEEP, 15.0, 20.0, (4.99, 0.0)) == ASLEEP
    assert grown(numbers, ASLEEP, 5.0, 9.0, (5.01, 0.0)) == ASLEEP
    assert grown(numbers, ASLEEP, 15.0, 20.0, (0.0, 5.01)) == [20.0, 20.0, 5.0]


def test_widening_in_one_step_equals_widening_in_many():
    state = [10.0, 20.0, 1.0]
    whole = grown(VERHEIJ, state, 110.0, 3710.0, (4.0, 2.0))
    split = state
    for k in range(20):
        split = grown(VERHEIJ, split, 110.0 + 180.0 * k, 290.0 + 180.0 * k, (4.0, 2.0))
    assert whole[1] == pytest.approx(20.0 + 20.0 * 2.0**1.5 * np.log10(1.0 + 2.0 * 1.0))
    assert split[1] == pytest.approx(whole[1], rel=1e-12)


def test_the_lower_level_counts_no_less_than_the_bottom():
    state = [10.0, 20.0, 1.0]
    dry, shallow = (grown(VERHEIJ, state, 110.0, 3710.0, (4.0, depth))[1] for depth in (0.0, 0.9))
    assert dry == shallow
    assert grown(VERHEIJ, state, 110.0, 3710.0, (2.0, 2.0))[1] == 20.0
