from pathlib import Path

from solver_service.scenario import load_case
from tests.solver_service.tiny_case import CASE, write_case


def test_solver_keys_reach_the_solver(tmp_path: Path) -> None:
    more = 'cfl = 0.3\norder = 1\nriemann = "hll"\ndepth_dry = 1e-6\ndepth_arrival = 0.1\n'

    params = load_case(write_case(tmp_path, CASE + more)).params

    assert (params.cfl, params.order, params.riemann) == (0.3, 1, "hll")
    assert (params.depth_dry, params.depth_arrival) == (1e-6, 0.1)
