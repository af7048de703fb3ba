"""What leaves the device beside the depth is what the rasters of the solver hold."""

import numpy as np
import pytest

from solver_service.numerics import FloodModel, ShallowWaterSolver, SolverParams
from solver_service.numerics.channel_kernels import gather_maxima, gather_velocity
from solver_service.numerics.fields import NEVER
from solver_service.numerics.read_out import MAXIMUM_NAMES, gathered

SHAPE = (40, 50)


@pytest.fixture(scope="module")
def flooded():
    """A pond that has run down a plane for a while."""
    z = np.broadcast_to(np.linspace(3.0, 0.0, SHAPE[1], dtype=np.float32), SHAPE).copy()
    h = np.zeros(SHAPE, np.float32)
    h[5:20, 3:12] = 1.5
    s = ShallowWaterSolver(FloodModel(10.0, z, 0.03), SolverParams(threads=1), "cpu")
    s.set_water(h)
    s.advance_to(40.0)
    return s


def test_velocity_is_that_of_the_solver(flooded):
    fields = flooded.velocity_fields()
    assert fields.dtype == np.float32
    for field, values in zip(fields, flooded.velocity(), strict=True):
        np.testing.assert_array_equal(field, values)
    assert np.abs(fields[0]).max() > 0.5


def test_maxima_are_those_of_the_solver(flooded):
    maxima = flooded.maxima()
    depth, speed, hazard, arrival = flooded.maximum_fields()
    np.testing.assert_array_equal(depth, maxima.h)
    np.testing.assert_array_equal(speed, maxima.speed)
    np.testing.assert_array_equal(hazard, maxima.hazard)
    came = arrival < np.float32(NEVER)
    np.testing.assert_array_equal(came, np.isfinite(maxima.arrival_time))
    np.testing.assert_array_equal(arrival[came], maxima.arrival_time[came])
    assert 10 < np.count_nonzero(came) < came.size


def test_water_that_was_raised_after_the_last_step_counts_as_the_largest(flooded):
    raised = ShallowWaterSolver(flooded.model, flooded.params, "cpu")
    raised.restore(flooded.snapshot())
    raised._store.write("h", flooded.maxima().h + np.float32(1.0))
    np.testing.assert_array_equal(raised.maximum_fields()[0], flooded.maxima().h + np.float32(1.0))


def test_a_device_with_memory_of_its_own_gathers_the_same(flooded):
    store = flooded._store
    velocity = gathered(gather_velocity, [store.current("u"), store.current("v")], 2, store)
    np.testing.assert_array_equal(velocity, flooded.velocity_fields())
    arrays = [store.current("h"), *(store.arrays[name] for name in MAXIMUM_NAMES)]
    np.testing.assert_array_equal(gathered(gather_maxima, arrays, 4, store), flooded.maximum_fields())


def test_what_was_read_does_not_change_with_the_next_step(flooded):
    before = flooded.maximum_fields(), flooded.velocity_fields()
    kept = [fields.copy() for fields in before]
    flooded.advance_to(flooded.time + 5.0)
    for fields, copy in zip(before, kept, strict=True):
        np.testing.assert_array_equal(fields, copy)
    assert (flooded.velocity_fields() != kept[1]).any()
