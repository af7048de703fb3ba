import re
from pathlib import Path

import pytest

from solver_service.numerics import ShallowWaterSolver
from solver_service.offline import OfflineOptions, run_case
from solver_service.offline.summary import SmallestStep
from solver_service.scenario import load_case
from tests.solver_service.dry_case import loaded
from tests.solver_service.tiny_case import CASE, write_case

SOURCE = '\n[[source]]\nid = "pipe"\nat = [1055.0, 2125.0]\nradius = 20.0\ndischarge = 60.0\n'
RAIN = "\n[rain]\nrate = 400.0\n"
GROUND = '\n[infiltration]\nmodel = "constant"\nrate = 90.0\n'


def test_the_whole_budget_stands_in_the_summary_and_closes(tmp_path: Path) -> None:
    summary = run_case(loaded(tmp_path, SOURCE + RAIN + GROUND), OfflineOptions(device="cpu"))

    budget = summary["water_budget_m3"]
    assert budget["sources"] == {"pipe": pytest.approx(60.0 * 20.0, rel=1e-3)}
    assert budget["rain"] == pytest.approx(0.4 / 3600.0 * 20.0 * 960 * 100.0, rel=1e-2)
    assert 0.0 < budget["infiltration"] < 0.25 * budget["rain"]
    assert list(budget["edges"]) == ["east-1"]
    came = budget["sources"]["pipe"] + budget["rain"]
    left = budget["infiltration"] + budget["outflow"]
    assert budget["stored"] == pytest.approx(came - left, rel=1e-7)
    assert abs(summary["volume_error_relative"]) < 1e-7


def test_the_smallest_step_is_told_with_its_cell_and_time(tmp_path: Path) -> None:
    case = load_case(write_case(tmp_path))
    summary = run_case(case, OfflineOptions(device="cpu"))

    smallest = summary["smallest_mean_step"]
    assert 0.0 < smallest["dt_s"] < 20.0 / summary["steps"] * 1.5
    assert smallest["time_s"] in (5.0, 10.0, 15.0, 20.0)
    assert case.grid.center(smallest["row"], smallest["col"]) == (smallest["x_m"], smallest["y_m"])


def test_only_a_smaller_step_replaces_the_smallest(tmp_path: Path) -> None:
    case = load_case(write_case(tmp_path))
    solver = ShallowWaterSolver(case.model, case.params, "cpu")
    solver.set_water(case.initial_h)
    smallest = SmallestStep(case.grid)
    seen = []
    for time in (1.0, 2.0, 10.0, 20.0):
        solver.advance_to(time)
        smallest.look(solver)
        seen.append(smallest.figures["dt_s"])

    assert seen == sorted(seen, reverse=True)
    assert smallest.figures["dt_s"] == min(seen)


def test_odd_things_of_the_case_are_told_again(tmp_path: Path) -> None:
    summary = run_case(loaded(tmp_path, "\n[rain]\nrate = 600.0\n"), OfflineOptions(device="cpu", until=1.0))

    (warning,) = summary["warnings"]
    assert "a rain of 600 mm/h is odd" in warning


def test_a_breach_that_never_starts_is_told(tmp_path: Path) -> None:
    breach = """
[[breach]]
line = [[1105.0, 2085.0], [1105.0, 2155.0]]
start = "overtopping"
crest = 320.0
bottom_level = 301.0
duration = 5.0
width_final = 40.0
"""
    case = load_case(write_case(tmp_path, CASE + breach))

    summary = run_case(case, OfflineOptions(device="cpu", until=2.0))

    assert summary["warnings"] == ["The breach 'breach-1' never started."]
    (told,) = summary["breaches"]
    assert (told["breach"], told["started_at_s"], told["width_m"]) == ("breach-1", None, 0.0)
    assert told["level_m"] == pytest.approx(320.0)


def test_outflow_that_the_water_at_an_edge_did_not_allow_is_told(tmp_path: Path) -> None:
    case = load_case(write_case(tmp_path, CASE.replace('"open"', '"discharge"\ndischarge = -5.0')))

    summary = run_case(case, OfflineOptions(device="cpu", until=4.0))

    (warning,) = summary["warnings"]
    told = re.fullmatch(
        "The discharge 'east-1' was to take out (.+) m3 more than there was at the edge.", warning
    )
    assert told is not None
    assert 15.0 < float(told[1]) <= 20.0  # all but what the last step still owes
    assert summary["water_budget_m3"]["edges"]["east-1"] == {"in": 0.0, "out": 0.0}
