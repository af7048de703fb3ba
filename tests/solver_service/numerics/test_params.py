"""Ranges of the solver parameters."""

import math

import pytest

from solver_service.numerics import ModelError, SolverParams


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("cfl", 0.0),
        ("cfl", 0.6),
        ("cfl", math.nan),
        ("order", 3),
        ("riemann", "roe"),
        ("limiter_theta", 2.0),
        ("depth_dry", -1.0),
        ("depth_film", 0.1),
        ("depth_arrival", 0.0),
        ("dt_min", 0.0),
        ("dt_max", 0.0),
        ("threads", 0),
        ("gauge_interval", 0.0),
        ("engine", "gpu"),
    ],
)
def test_a_value_out_of_range_is_refused_by_name(name, value):
    with pytest.raises(ModelError, match=name):
        SolverParams(**{name: value})
