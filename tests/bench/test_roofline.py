"""Ceilings of a cell-step from the compiled step."""

import pytest

from bench import kernels, roofline
from bench.cubin import BARRIER, CLASSES, CompiledKernel
from solver_service.numerics.fields import MAXIMA_NAMES

ADD, LOAD = CLASSES["float"][1], CLASSES["global load"][0]


def step_of(*phases):
    opcodes = [opcode for phase in phases for opcode in (*phase, BARRIER)]
    return CompiledKernel(kernels.STEP, 64, 0, 0, tuple(opcodes))


def test_instructions_count_as_often_as_a_lane_takes_the_phase():
    nothing, two = (), (ADD, LOAD)
    assert roofline.step_cost(step_of(nothing, two, nothing, nothing, nothing, nothing)).instructions == (
        pytest.approx(3 * 4 / 8 + 1 + 10 / 8 + 9 / 8 + 1 + 1 / 8)
    )


def test_operations_are_the_arithmetic_of_predict_faces_and_update():
    cost = roofline.step_cost(step_of((ADD,), (ADD,), (ADD, LOAD), (ADD, ADD), (ADD,), ()))
    assert cost.operations == 4


def test_a_step_with_unknown_phases_is_refused():
    with pytest.raises(ValueError, match="3 phases; 7 are known"):
        roofline.step_cost(step_of((), ()))


def test_bytes_of_a_cell_step_are_those_of_its_arrays():
    assert roofline.bytes_per_cell_step(0) == 4 * (6 + 2 + len(MAXIMA_NAMES))
    assert roofline.bytes_per_cell_step(8) - roofline.bytes_per_cell_step(0) == 32


def test_every_ceiling_names_what_limits_it():
    lines = {line["figure"]: line for line in roofline.figures(smoke=True)}
    for line in lines.values():
        assert line["limit"] in ("arithmetic", "memory")
        assert line["value"] == min(line["arithmetic_ceiling"], line["memory_ceiling"])
    assert lines["ceiling_H200"]["measured"] is None
    core = lines["ceiling_cpu_core"]
    assert 0.0 < core["measured"] < core["arithmetic_ceiling"]
