from pathlib import Path

import pytest

from solver_service.errors import CaseError
from solver_service.scenario import load_case
from tests.solver_service.tiny_case import CASE, write_case


def test_solver_keys_reach_the_solver(tmp_path: Path) -> None:
    more = 'cfl = 0.3\norder = 1\nriemann = "hll"\ndepth_dry = 1e-6\ndepth_arrival = 0.1\n'
    more += "depth_film = 1e-7\ndepth_cfl = 0.01\neddy_viscosity = 0\narrival_depths = [0.15, 0.3, 1]\n"

    params = load_case(write_case(tmp_path, CASE + more)).params

    assert (params.cfl, params.order, params.riemann) == (0.3, 1, "hll")
    assert (params.depth_dry, params.depth_arrival) == (1e-6, 0.1)
    assert (params.depth_cfl, params.eddy_viscosity) == (0.01, 0.0)
    assert (params.depth_film, params.arrival_depths) == (1e-7, (0.15, 0.3, 1.0))


@pytest.mark.parametrize(
    ("key", "message"),
    [
        ("arrival_depths = []", r"arrival_depths is \[\]; 1 to 8 depths in m above 0, each above the last"),
        ("arrival_depths = 0.5", "arrival_depths is 0.5"),
        ("arrival_depths = [0.5, 0.5]", "each above the last"),
        ("arrival_depths = [0.0, 0.5]", "each above the last"),
        ("arrival_depths = [1, 2, 3, 4, 5, 6, 7, 8, 9]", "1 to 8 depths"),
        ("depth_cfl = 1.0", "depth_cfl is 1.0; a depth in m from 0 to 0.05"),
        ("eddy_viscosity = -1.0", "eddy_viscosity is -1.0; a number from 0 to 100"),
        ("depth_film = 0.01", r"depth_film is 0.01; a depth in m from 0.00000001 to depth_dry \(0.001\)"),
    ],
)
def test_bad_depths_are_told(tmp_path: Path, key: str, message: str) -> None:
    with pytest.raises(CaseError, match=message):
        load_case(write_case(tmp_path, f"{CASE}{key}\n"))
