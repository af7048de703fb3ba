from solver_service.scenario import load_case
from tests.solver_service.tiny_case import CASE, write_case


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
