import numpy as np
import pytest

from solver_service.scenario import load_case
from solver_service.scenario.case import Section
from tests.solver_service.tiny_case import CASE, write_case


def test_a_section_samples_its_line_once_a_cell_and_knows_its_right() -> None:
    section = Section.along("bridge", ((0.0, 100.0), (0.0, 0.0), (30.0, 0.0)), 10.0)

    assert section.x.size == 13
    assert section.ds.sum() == pytest.approx(130.0)
    # Going south the right is west, going east it is south.
    np.testing.assert_allclose(section.normal_x, [-1.0] * 10 + [0.0] * 3, atol=1e-12)
    np.testing.assert_allclose(section.normal_y, [0.0] * 10 + [-1.0] * 3, atol=1e-12)
    assert (section.x[0], section.y[0]) == (0.0, 95.0)


def test_a_vertex_that_stands_twice_adds_nothing() -> None:
    section = Section.along("bridge", ((0.0, 0.0), (0.0, 0.0), (40.0, 0.0)), 10.0)

    assert section.x.tolist() == [5.0, 15.0, 25.0, 35.0]


def test_a_case_without_a_tour_has_no_demo_edit(tmp_path) -> None:
    assert load_case(write_case(tmp_path)).demo_edit is None
    edit = """
[demo]
time = 3.0
[[demo.edit]]
line = [[1150.0, 2050.0], [1150.0, 2150.0]]
width = 20.0
magnitude = 3.0
"""
    case = load_case(write_case(tmp_path, CASE + edit))
    assert [levee.magnitude for levee in case.demo_edit] == [3.0]
    assert case.demo.time == 3.0
