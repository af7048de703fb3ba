"""What leaves the device beside the depth is what the rasters of the solver hold."""

import numpy as np
import pytest

from solver_service.numerics import FloodModel, ShallowWaterSolver, SolverParams

SHAPE = (40, 50)
DEPTH_WET = 1e-3


@pytest.fixture(scope="module")
def flooded():
    """A pond that has run down a plane for a while."""
    z = np.broadcast_to(np.linspace(3.0, 0.0, SHAPE[1], dtype=np.float32), SHAPE).copy()
    h = np.zeros(SHAPE, np.float32)
    h[5:20, 3:12] = 1.5
    model = FloodModel(10.0, z, 0.03)
    s = ShallowWaterSolver(model, SolverParams(threads=1), "cpu")
    s.set_water(h)
    s.advance_to(40.0)
    return s


def test_velocity_is_that_of_the_wet_cells(flooded):
    u, v = flooded.velocity()
    wet = flooded.depth() >= DEPTH_WET
    east, north = flooded.velocity_fields(DEPTH_WET)
    assert east.dtype == np.float32
    np.testing.assert_array_equal(east, np.where(wet, u, 0.0))
    np.testing.assert_array_equal(north, np.where(wet, v, 0.0))
    assert 0 < np.count_nonzero(wet) < wet.size
    assert np.abs(east).max() > 0.5


def test_maxima_are_those_of_the_solver_where_water_came(flooded):
    maxima = flooded.maxima()
    depth, speed, hazard, arrival = flooded.maximum_fields(DEPTH_WET)
    reached = maxima.h >= DEPTH_WET
    np.testing.assert_array_equal(depth, np.where(reached, maxima.h, 0.0))
    np.testing.assert_array_equal(speed, np.where(reached, maxima.speed, 0.0))
    np.testing.assert_array_equal(hazard, np.where(reached, maxima.hazard, 0.0))
    np.testing.assert_array_equal(np.isinf(arrival), np.isnan(maxima.arrival_time))
    came = np.isfinite(arrival)
    np.testing.assert_array_equal(arrival[came], maxima.arrival_time[came])
    assert len(np.unique(arrival[came])) > 10
    assert not reached.all()


def test_what_was_read_does_not_change_with_the_next_step(flooded):
    before = flooded.maximum_fields(DEPTH_WET), flooded.velocity_fields(DEPTH_WET)
    kept = [fields.copy() for fields in before]
    flooded.advance_to(flooded.time + 5.0)
    for fields, copy in zip(before, kept, strict=True):
        np.testing.assert_array_equal(fields, copy)
    assert (flooded.velocity_fields(DEPTH_WET) != kept[1]).any()
