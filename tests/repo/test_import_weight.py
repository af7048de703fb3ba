"""What an import brings along: a laptop needs no solver, a GPU server no OpenGL."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[2]


def modules_after_import(name: str) -> set[str]:
    code = f"import {name}, json, sys; print(json.dumps(sorted(sys.modules)))"
    command = [sys.executable, "-P", "-c", code]
    answer = subprocess.run(command, cwd=REPOSITORY, capture_output=True, text=True, timeout=60, check=True)
    return {module.partition(".")[0] for module in json.loads(answer.stdout)}


@pytest.mark.parametrize(
    ("name", "unwanted"),
    [
        (
            "protocol",
            {"warp", "fastapi", "moderngl", "zarr", "PySide6", "asyncio", "solver_service", "viewer"},
        ),
        ("solver_service", {"warp", "fastapi", "moderngl", "zarr", "PySide6", "viewer"}),
        ("viewer", {"warp", "fastapi", "zarr", "PySide6", "moderngl", "solver_service"}),
        ("viewer.world", {"warp", "zarr", "PySide6", "moderngl", "websockets", "solver_service"}),
        ("viewer.lod", {"warp", "zarr", "PySide6", "moderngl", "websockets", "solver_service"}),
        ("viewer.render", {"warp", "zarr", "PySide6", "websockets", "solver_service"}),
        ("viewer.cli", {"warp", "fastapi", "zarr", "solver_service"}),
        ("solver_service.cli", {"moderngl", "PySide6", "viewer"}),
    ],
)
def test_an_import_brings_along_nothing_heavy(name: str, unwanted: set[str]) -> None:
    assert not modules_after_import(name) & unwanted


def test_the_packages_are_ours_from_any_folder(tmp_path: Path) -> None:
    # `protocol` is also the name of a package on PyPI, and a folder of that name must not win over ours.
    (tmp_path / "protocol").mkdir()
    (tmp_path / "protocol" / "__init__.py").write_text("raise ImportError('not ours')\n")
    code = "import protocol as p, solver_service as s, viewer as v; print(p.__file__, s.__file__, v.__file__)"

    answer = subprocess.run(
        [sys.executable, "-P", "-c", code],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )

    assert answer.returncode == 0, answer.stderr
    expected = [str(REPOSITORY / name / "__init__.py") for name in ("protocol", "solver_service", "viewer")]
    assert answer.stdout.strip() == " ".join(expected)
