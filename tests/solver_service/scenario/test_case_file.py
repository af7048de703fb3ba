from pathlib import Path

import numpy as np
import pytest

from solver_service.errors import CaseError
from solver_service.scenario import load_case
from solver_service.scenario.case_file import planned_grid
from solver_service.scenario.case_folder import open_case
from tests.solver_service.tiny_case import CASE, write_case


def test_what_the_case_says_arrives(tmp_path: Path) -> None:
    case = load_case(
        write_case(tmp_path, CASE.replace("[case]", "[case]\nstart_time = 1959-12-02T21:14:00+01:00"))
    )

    assert (case.name, case.title, case.hypothetical) == ("tiny", "A dam in a valley", True)
    assert (case.source, case.licence) == ("made up", "public domain")
    assert (case.duration, case.output_interval, case.params.gauge_interval) == (20.0, 5.0, 1.0)
    assert case.start_time == "1959-12-02T21:14:00+01:00"
    assert case.grid.vertical_datum == "the floor"
    assert case.model.dx == 10.0
    assert case.model.z_b.shape == case.initial_h.shape == case.grid.shape
    np.testing.assert_array_equal(case.model.z_b, case.z_b)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("[case]", "[case", "is no valid TOML"),
        ("[case]", "x = 1\n[case]", "the top of the file has the unknown key 'x'"),
        ("[run]", "[rum]", "unknown key 'rum'; did you mean 'run'"),
        ("[roughness]\nmanning_n = 0.03", "", r"the table \[roughness\] is missing"),
        ('name = "tiny"', 'name = "a/b"', "name is 'a/b'; 1 to 64 letters"),
        ('name = "tiny"', "", "name is missing"),
        ("duration = 20.0", "duration = 0", "duration is 0; a time in s above 0"),
        ("duration = 20.0", "duration = inf", "duration is inf"),
        (
            "duration = 20.0",
            "durations = 20.0",
            r"\[run\] has the unknown key 'durations'; did you mean 'duration'",
        ),
        ("output_interval = 5.0", "output_interval = 0.0", "output_interval is 0.0"),
        ("output_interval = 5.0", "output_interval = 21.0", "up to the duration of 20"),
        ("output_interval = 5.0", "output_interval = 1e-9", "at most 1000000 frames"),
        ("gauge_interval = 1.0", "gauge_interval = 0.0", "gauge_interval is 0.0"),
        ("gauge_interval = 1.0", "order = 3", "order is 3; 1 or 2 is allowed"),
        ("gauge_interval = 1.0", "order = true", "order is True"),
        ("gauge_interval = 1.0", "cfl = 0.9", "cfl is 0.9; a Courant number above 0, up to 0.5, is allowed"),
        ("gauge_interval = 1.0", "depth_dry = -0.001", "depth_dry is -0.001"),
        ("hypothetical = true", 'hypothetical = "yes"', "hypothetical is 'yes'; true or false"),
        ("hypothetical = true", 'start_time = "1959-12-02T21:14:00"', "an ISO-8601 time with an offset"),
    ],
)
def test_a_bad_case_is_told_in_one_sentence(tmp_path: Path, old: str, new: str, message: str) -> None:
    assert old in CASE

    with pytest.raises(CaseError, match=message) as caught:
        load_case(write_case(tmp_path, CASE.replace(old, new, 1)))

    assert str(caught.value).startswith("case.toml: ")
    assert "\n" not in str(caught.value)


def test_deeply_nested_toml_is_refused(tmp_path: Path) -> None:
    with pytest.raises(CaseError, match="is no valid TOML"):
        load_case(write_case(tmp_path, "x = " + "[" * 100_000))


def test_the_grid_is_known_without_the_terrain_where_the_case_says_it(tmp_path: Path) -> None:
    text = CASE.replace('key = "bed"', "bounds = [1000.0, 2000.0, 1400.0, 2240.0]\ncell_size = 20.0")
    write_case(tmp_path, text)

    with open_case(tmp_path) as folder:
        planned = planned_grid(folder)
    assert planned.shape == load_case(tmp_path).grid.shape == (12, 20)

    with open_case(write_case(tmp_path / "other")) as folder:
        assert planned_grid(folder) is None
