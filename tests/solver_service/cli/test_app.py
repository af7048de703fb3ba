import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests.solver_service.tiny_case import CASE, write_case

COMMANDS = ("run", "check", "cases", "serve", "export", "warmup", "doctor")


def test_help_lists_every_command_and_loads_no_solver() -> None:
    code = (
        "import sys; sys.argv[1:] = ['--help']\n"
        "from solver_service.cli import main\n"
        "try: main()\n"
        "except SystemExit: pass\n"
        "heavy = {'warp', 'numpy', 'rasterio', 'scipy', 'fastapi', 'zarr', 'pyproj'} & set(sys.modules)\n"
        "print('HEAVY', sorted(heavy))\n"
    )
    began = time.monotonic()
    answer = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=True
    )

    assert all(command in answer.stdout for command in COMMANDS)
    assert "HEAVY []" in answer.stdout
    assert time.monotonic() - began < 30.0


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("run", "atlantis"), "There is no case 'atlantis'; jacksboro, malpasset"),
        (("check", "atlantis"), "There is no case 'atlantis'"),
        (("run", "{case}", "--device", "cuda:17"), "device 'cuda:17' is not there; available are auto, cpu"),
        (("warmup", "--device", "cuda:17"), "device 'cuda:17' is not there"),
        (("run", "{case}", "--until", "-5"), "until is -5 s; a time above 0"),
        (("run", "{case}", "--until", "nan"), "until is nan s"),
        (("run", "{case}", "--threads", "0"), "threads is 0; 1 or more"),
        (("run", "{case}", "--cell-size", "-1"), "cell size is -1 m; 0.001 to 100000 m"),
        (("run", "{case}", "--zarr"), "need an output folder; give --out"),
        (("run", "{case}", "--out", "{case}/case.toml"), "is a file; a folder is allowed"),
        (("serve", "--threads", "0"), "--threads is 0; a whole number from 1"),
        (("export", "abc", "--out", "{case}/out", "--data-dir", "{case}"), "holds no runs"),
    ],
)
def test_bad_input_is_one_sentence_and_exit_code_2(tmp_path: Path, fev_solver, words, message: str) -> None:
    case = write_case(tmp_path / "case")

    answer = fev_solver(*(word.format(case=case) for word in words))

    assert answer.code == 2
    lines = [line for line in answer.err.splitlines() if "CUDA" not in line]
    assert len(lines) == 1, answer.err
    assert lines[0].startswith("fev-solver: ")
    assert message in lines[0]
    assert answer.out == ""


def test_a_bad_case_file_is_one_sentence(tmp_path: Path, fev_solver) -> None:
    write_case(tmp_path, CASE.replace("manning_n = 0.03", "manning_n = -0.03"))

    answer = fev_solver("run", tmp_path, "--out", tmp_path / "out")

    assert answer.code == 2
    assert "case.toml: [roughness] manning_n is -0.03; a Manning roughness from 0 to 1" in answer.err
    assert not (tmp_path / "out").exists()


def test_an_unknown_option_is_refused(fev_solver) -> None:
    answer = fev_solver("run", "jacksboro", "--untl", "5")

    assert answer.code == 2
    assert "--untl" in answer.err


def test_an_interrupt_ends_without_a_traceback(
    tmp_path: Path, fev_solver, monkeypatch: pytest.MonkeyPatch
) -> None:
    from solver_service.cli import run

    def interrupt(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(run, "run_offline", interrupt)

    answer = fev_solver("run", "jacksboro")

    assert answer.code == 130
    assert "Traceback" not in answer.err
