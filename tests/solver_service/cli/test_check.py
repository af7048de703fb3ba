import json
from pathlib import Path

from tests.solver_service.tiny_case import CASE, GAUGES, write_case


def test_a_check_tells_what_stands_in_a_case(tmp_path: Path, fev_solver) -> None:
    answer = fev_solver("check", write_case(tmp_path, CASE + GAUGES), "--device", "cpu")

    assert answer.code == 0
    for word in (
        "coordinates",
        "local, metres",
        "cells without data",
        "single-cell pits",
        "time to run",
        "memory",
    ):
        assert word in answer.out
    assert "nothing odd was found" in answer.out


def test_warnings_are_told_for_people_and_programs(tmp_path: Path, fev_solver) -> None:
    dry = CASE[: CASE.index("[[initial.level]]")] + CASE[CASE.index("[[boundary]]") :]
    write_case(tmp_path, dry)

    assert "warning: There is no water" in fev_solver("check", tmp_path, "--device", "cpu").out
    figures = json.loads(fev_solver("check", tmp_path, "--device", "cpu", "--json").out.splitlines()[-1])
    assert figures["cells"] == 960
    assert any("no water" in warning for warning in figures["warnings"])


def test_cases_are_listed_and_a_broken_one_does_not_hide_the_others(
    tmp_path: Path, fev_solver, monkeypatch
) -> None:
    write_case(tmp_path / "broken", "[case]\n")
    monkeypatch.setenv("FEV_DATA_HOME", str(tmp_path))

    answer = fev_solver("cases")

    assert answer.code == 0
    assert "jacksboro       Hypothetical dam break" in answer.out
    assert "malpasset" in answer.out
    assert "case.toml: [case] name is missing" in answer.err or "the table [run] is missing" in answer.err
    names = [case["name"] for case in json.loads(fev_solver("cases", "--json").out)]
    assert names == ["jacksboro", "malpasset"]


def test_the_cells_of_what_is_built_go_into_a_map_file(tmp_path: Path, fev_solver) -> None:
    write_case(tmp_path, CASE + GAUGES)

    answer = fev_solver("check", tmp_path, "--device", "cpu", "--geojson", tmp_path / "built.geojson")

    assert answer.code == 0
    features = json.loads((tmp_path / "built.geojson").read_text())["features"]
    assert [feature["properties"]["id"] for feature in features][:2] == ["east-1", "upper"]
