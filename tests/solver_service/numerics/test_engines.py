"""One flood through every engine: scalar kernels, SIMD rows, strips over threads."""

import numpy as np
import pytest

from tests.solver_service.numerics.floods import GAUGES, bed, differences, full_model, solver, wild_water

TIMES = (1.3, 6.0, 11.0)


def run(model, water, **params):
    s = solver(model, gauges=GAUGES, gauge_interval=0.35, **params)
    s.set_water(*water)
    for time in TIMES:
        s.advance_to(time)
    return s


@pytest.mark.parametrize("scheme", [{}, {"order": 1}, {"riemann": "hll"}, {"limiter_theta": 1.0}])
def test_rows_equal_the_scalar_kernels_bit_for_bit(scheme):
    model = full_model()
    water = wild_water(model.z_b)
    oracle = run(model, water, engine="kernels", **scheme)
    assert differences(oracle, run(model, water, engine="rows", threads=1, **scheme)) == []
    assert oracle.step_count > 20


def test_any_number_of_threads_gives_the_same_bits():
    model = full_model(rain=False)
    water = wild_water(model.z_b)
    one = run(model, water, engine="rows", threads=1)
    for threads in (2, 3, 7):
        assert differences(one, run(model, water, engine="rows", threads=threads)) == []


def test_engines_agree_on_a_grid_smaller_than_a_tile():
    z = bed((5, 9))
    water = (np.full(z.shape, 1.0, np.float32), np.full(z.shape, 0.5, np.float32))
    from solver_service.numerics import FloodModel

    model = FloodModel(2.0, z, 0.03)
    runs = [solver(model, engine=engine, threads=1) for engine in ("kernels", "rows")]
    for s in runs:
        s.set_water(*water)
        s.advance_to(5.0)
    assert differences(*runs) == []


def test_scalar_kernels_are_used_when_the_row_loops_do_not_compile(monkeypatch, caplog):
    from solver_service.errors import DeviceError
    from solver_service.numerics import row_engine
    from solver_service.numerics import solver as solver_module
    from solver_service.numerics.kernel_engine import KernelEngine

    def refuse(device):
        raise DeviceError("no compiler")

    monkeypatch.setattr(row_engine, "warm_kernels", refuse)
    monkeypatch.setattr(solver_module, "rows_compile", row_engine.rows_compile.__wrapped__)
    s = solver(full_model())
    assert isinstance(s._engine, KernelEngine)
    assert "no compiler" in caplog.text
