import tomllib
from importlib.metadata import PackageNotFoundError
from pathlib import Path

import pytest

from solver_service.web import version
from solver_service.web.version import server_version

REPOSITORY = Path(__file__).resolve().parents[3]


def test_the_service_tells_the_version_of_the_project() -> None:
    project = tomllib.loads((REPOSITORY / "pyproject.toml").read_text(encoding="utf-8"))["project"]

    assert server_version() == project["version"]


def test_a_source_tree_that_is_not_installed_has_version_0(monkeypatch: pytest.MonkeyPatch) -> None:
    def missing(name: str) -> str:
        raise PackageNotFoundError(name)

    monkeypatch.setattr(version, "version", missing)

    assert server_version() == "0"
