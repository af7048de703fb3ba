"""Records of gauges and sections, frame by frame, are those of the solver, each once."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from solver_service.numerics import ShallowWaterSolver
from solver_service.runs.frame_series import frame_series, record_count
from solver_service.scenario import Case, load_case
from tests.end_to_end.test_breach_case import FOLDER


@given(st.integers(0, 10**6), st.floats(1e-3, 1e3))
def test_as_many_records_as_the_solver_has_made(number: int, interval: float) -> None:
    time = number * interval
    count = record_count(time, interval)
    assert (count - 1) * interval <= time < count * interval
    assert count == number + 1


@pytest.fixture(scope="module")
def case() -> Case:
    return load_case(FOLDER)


def test_the_records_of_the_frames_are_those_of_the_whole_run_each_once(case: Case) -> None:
    solver = ShallowWaterSolver(case.model, case.params, "cpu")
    solver.set_water(case.initial_h)
    pieces = []
    for index in range(16):
        solver.advance_to(index * case.output_interval)
        pieces.append(frame_series(case, solver, "r", index, case.output_interval))
    seen, passed = solver.gauge_series(), solver.section_series()
    assert len(seen.times) > 16
    np.testing.assert_array_equal(np.concatenate([piece.times for piece in pieces]), seen.times)
    values = np.concatenate([piece.gauge_values for piece in pieces])
    np.testing.assert_array_equal(values[..., 0], seen.h)
    np.testing.assert_array_equal(values[..., 1], seen.eta)
    np.testing.assert_array_equal(values[..., 3], seen.v)
    flows = np.concatenate([piece.section_values for piece in pieces])
    count = len(case.sections)
    assert count < passed.discharge.shape[1], "the lines of weirs and breaches follow"
    np.testing.assert_array_equal(flows[..., 0], passed.discharge[:, :count])
    np.testing.assert_array_equal(flows[..., 1], passed.volume[:, :count])
    assert pieces[0].gauges == tuple(gauge.id for gauge in case.gauges)
    assert np.abs(flows[..., 0]).max() > 0.1
