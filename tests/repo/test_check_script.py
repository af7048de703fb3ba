"""`.ci/run` refuses what it does not know, runs single stages, and fails when a stage fails."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[2]

pytestmark = pytest.mark.skipif(shutil.which("bash") is None, reason="bash is not installed")


def copy_of_the_script(folder: Path, status_of_mypy: int) -> Path:
    """The script in a repository whose ./fev and mypy do nothing but end with a status."""
    programs = {"fev": 0, ".venv/bin/mypy": status_of_mypy, ".venv/bin/lint-imports": 0}
    for name, status in programs.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f"#!/bin/sh\necho {path.name} ran\nexit {status}\n")
        path.chmod(0o755)
    script = folder / ".ci" / "run"
    script.parent.mkdir()
    shutil.copy(REPOSITORY / ".ci" / "run", script)
    return script


def run(script: Path, *stages: str) -> subprocess.CompletedProcess[str]:
    environment = dict(os.environ, CI="true")
    command = ["bash", str(script), *stages]
    return subprocess.run(command, env=environment, capture_output=True, text=True, timeout=60, check=False)


def test_an_unknown_stage_is_refused_before_anything_runs(tmp_path: Path) -> None:
    answer = run(copy_of_the_script(tmp_path, 0), "layers", "fly")

    assert answer.returncode == 2
    assert "unknown stage 'fly'" in answer.stderr
    assert "ran" not in answer.stdout


def test_single_stages_run_in_the_order_asked_and_tell_their_seconds(tmp_path: Path) -> None:
    answer = run(copy_of_the_script(tmp_path, 0), "layers", "types")

    assert answer.returncode == 0, answer.stderr
    order = [line for line in answer.stdout.splitlines() if line.endswith(" ran")]
    assert order == ["fev ran", "lint-imports ran", "mypy ran"]
    assert "== types: 0 s" in answer.stdout


def test_the_first_failing_stage_ends_the_check_with_its_status(tmp_path: Path) -> None:
    answer = run(copy_of_the_script(tmp_path, 3), "types", "layers")

    assert answer.returncode == 3
    assert "types: failed" in answer.stderr
    assert "lint-imports ran" not in answer.stdout
