import json
from pathlib import Path

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


def test_what_a_server_lacks_is_a_line_and_the_exit_code(tmp_path: Path, fev_solver) -> None:
    config = tmp_path / "server.toml"
    config.write_text('device = "cuda:99"\n')
    answer = fev_solver("doctor", "--config", config)
    bad = [line for line in answer.out.splitlines() if line.startswith("BAD")]
    assert answer.code == 1
    assert len(bad) == 1
    assert "cuda:99" in bad[0]
    assert sum(line.startswith("ok ") for line in answer.out.splitlines()) == 8

    config.write_text(f'data_dir = "{tmp_path}/data"\n')
    answer = fev_solver("doctor", "--config", config, "--json")
    assert answer.code == 0
    assert all(check["is_good"] for check in json.loads(answer.out.splitlines()[-1])["checks"])
