"""Who may import whom: the contracts of pyproject.toml, kept by the code, and shown to notice a breach."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[2]
LINT_IMPORTS = "from importlinter.cli import lint_imports_command as main; main(['--no-cache'])"


def lint_imports(folder: Path) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-P", "-c", f"import sys; sys.path.insert(0, {str(folder)!r}); {LINT_IMPORTS}"]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=120, check=False)


def test_every_layer_contract_is_kept() -> None:
    answer = lint_imports(REPOSITORY)

    assert answer.returncode == 0, answer.stdout + answer.stderr
    assert ", 0 broken" in answer.stdout


@pytest.mark.parametrize(
    ("package", "breach"),
    [
        ("protocol", "import viewer"),
        ("protocol", "import asyncio"),
        ("protocol", "import solver_service"),
        ("solver_service/numerics", "import protocol"),
        ("solver_service/terrain", "import solver_service.web"),
        ("solver_service", "import moderngl"),
        ("viewer/world", "import PySide6"),
        ("viewer/lod", "import viewer.render"),
        ("viewer/render", "import protocol"),
        ("viewer/net", "import fcntl"),
        ("viewer", "import solver_service"),
    ],
)
def test_a_wrong_import_is_noticed(tmp_path: Path, package: str, breach: str) -> None:
    ignored = shutil.ignore_patterns("__pycache__", "cases", "shaders")
    for name in ("protocol", "solver_service", "viewer"):
        shutil.copytree(REPOSITORY / name, tmp_path / name, ignore=ignored)
    shutil.copy(REPOSITORY / "pyproject.toml", tmp_path)
    (tmp_path / package / "wrong.py").write_text(f'"""A breach."""\n\n{breach}\n')

    answer = lint_imports(tmp_path)

    assert answer.returncode != 0
    assert "wrong" in answer.stdout, answer.stdout + answer.stderr
