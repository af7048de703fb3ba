"""Gauges look between the steps and never shorten one."""

import numpy as np
import pytest

from solver_service.numerics import FloodModel, ModelError
from tests.solver_service.numerics.floods import bed, solver, wild_water


def begun(**params):
    z = bed()
    s = solver(FloodModel(5.0, z, 0.03), threads=1, **params)
    s.set_water(*wild_water(z))
    return s


@pytest.mark.parametrize("engine", ["rows", "kernels"])
def test_records_stand_at_multiples_of_the_interval(engine):
    s = begun(gauges=((10.0, 20.0),), gauge_interval=0.1, engine=engine)
    s.advance_to(2.0)
    times = s.gauge_series().times
    assert times == pytest.approx(np.arange(len(times)) * 0.1)
    assert len(times) in (20, 21)


def test_gauges_do_not_change_the_steps():
    plain, watched = begun(), begun(gauges=((10.0, 20.0),), gauge_interval=0.01)
    for s in (plain, watched):
        s.advance_to(1.0)
    assert np.array_equal(plain.depth(), watched.depth())
    assert plain.step_count == watched.step_count


def test_a_record_at_a_landing_is_the_state_there():
    s = begun(gauges=((10.2, 19.8),), gauge_interval=0.5)
    s.advance_to(1.0)
    g = s.gauge_series()
    assert g.h[2, 0] == s.depth()[20, 10]
    assert g.u[2, 0] == s.velocity()[0][20, 10]
    assert g.eta[2, 0] == pytest.approx(s.depth()[20, 10] + s.bed[20, 10])


def test_records_lie_between_the_states_around_them():
    s = begun(gauges=((10.0, 20.0),), gauge_interval=0.001)
    s.advance_to(0.5)
    h = s.gauge_series().h[:, 0]
    assert np.count_nonzero(abs(np.diff(h, 2)) > 1e-6) <= s.step_count
    assert len(np.unique(h)) > 100


def test_a_gauge_off_the_grid_is_refused():
    with pytest.raises(ModelError, match="off the grid"):
        begun(gauges=((90.0, 3.0),))
