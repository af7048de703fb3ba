import json

from solver_service.cli.doctor import LIBRARIES


def test_the_doctor_tells_devices_versions_and_cases(fev_solver) -> None:
    facts = json.loads(fev_solver("doctor", "--json").out.splitlines()[-1])

    assert "cpu" in facts["devices"]
    assert set(facts["libraries"]) == set(LIBRARIES)
    assert facts["libraries"]["warp-lang"][0].isdigit()
    assert "jacksboro" in facts["cases"]
    assert facts["cores"] >= 1


def test_a_person_gets_lines(fev_solver) -> None:
    out = fev_solver("doctor").out

    assert "devices:" in out
    assert "kernel cache" in out


def test_warming_up_compiles_and_takes_a_step(fev_solver) -> None:
    answer = fev_solver("warmup", "--device", "cpu")

    assert answer.code == 0
    assert "kernels for cpu are ready" in answer.out
