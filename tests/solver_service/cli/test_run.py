import json
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests.solver_service.tiny_case import CASE, GAUGES, write_case


def test_json_ends_with_one_object_that_keeps_the_contract(tmp_path: Path, fev_solver) -> None:
    case = write_case(tmp_path / "case", CASE + GAUGES)

    answer = fev_solver("run", case, "--json", "--device", "cpu", "--until", "10", "--out", tmp_path / "out")

    assert answer.code == 0
    figures = json.loads(answer.out.splitlines()[-1])
    assert (figures["case"], figures["cells"], figures["sim_time_s"], figures["device"]) == (
        "tiny",
        960,
        10.0,
        "cpu",
    )
    for key in ("steps", "wall_s", "cell_steps_per_s", "speed_x_real_time", "max_speed_m_s"):
        assert figures[key] > 0.0
    assert abs(figures["volume_error_relative"]) < 1e-6
    assert json.loads((tmp_path / "out" / "summary.json").read_text()) == figures


def test_a_person_gets_a_table_with_the_mark_and_the_licence(tmp_path: Path, fev_solver) -> None:
    answer = fev_solver("run", write_case(tmp_path), "--device", "cpu", "--until", "5")

    assert answer.code == 0
    assert "A dam in a valley (hypothetical)" in answer.out
    assert "licence: public domain" in answer.out
    for words in ("water volume error", "water at the start", "water at the end", "limited by cell (row"):
        assert words in answer.out


def test_the_cell_size_of_the_command_line_is_used(tmp_path: Path, fev_solver) -> None:
    answer = fev_solver("run", write_case(tmp_path), "--json", "--until", "5", "--cell-size", "20")

    assert json.loads(answer.out.splitlines()[-1])["cells"] == 240


@pytest.mark.skipif(sys.platform == "win32", reason="limits on file sizes are POSIX")
@pytest.mark.parametrize("option", ["--netcdf", "--zarr", "--json"])
def test_a_disk_that_takes_no_more_is_one_sentence_and_leaves_nothing(tmp_path: Path, option: str) -> None:
    case = write_case(tmp_path / "case", CASE.replace("duration = 20.0", "duration = 5.0"))
    code = (
        "import resource; resource.setrlimit(resource.RLIMIT_FSIZE, (300, 300))\n"
        "from solver_service.cli import main; main()"
    )
    (tmp_path / "results").mkdir()
    words = ["run", str(case), "--device", "cpu", "--out", str(tmp_path / "results" / "out"), option]

    answer = subprocess.run(
        [sys.executable, "-c", code, *words], capture_output=True, text=True, timeout=120, check=False
    )

    assert answer.returncode == 2, answer.stderr
    assert "Traceback" not in answer.stderr
    assert "results cannot be written to" in answer.stderr
    assert "nothing was kept" in answer.stderr
    assert list((tmp_path / "results").iterdir()) == []


@pytest.mark.skipif(sys.platform == "win32", reason="Windows ends a process without telling it")
def test_a_run_that_is_told_to_end_leaves_nothing(tmp_path: Path) -> None:
    long = CASE.replace("duration = 20.0", "duration = 1e7").replace("interval = 5.0", "interval = 20.0")
    case = write_case(tmp_path / "case", long)
    results = tmp_path / "results"
    results.mkdir()
    code = "from solver_service.cli import main; main()"
    words = [sys.executable, "-c", code, "run", case, "--device", "cpu", "--netcdf", "--out", results / "out"]

    with subprocess.Popen(words, stderr=subprocess.PIPE, text=True) as process:
        deadline = time.monotonic() + 60.0
        while not list(results.glob(".out-*/timesteps.nc")) and time.monotonic() < deadline:
            time.sleep(0.05)
        assert list(results.iterdir())
        process.terminate()
        _, said = process.communicate(timeout=60)

    assert process.returncode == 143
    assert "Traceback" not in said
    assert list(results.iterdir()) == []
