"""The wheel holds what the source tree holds, and the lock holds what pyproject asks for."""

import re
import subprocess
import sys
import tomllib
import zipfile
from collections.abc import Iterator

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name
from packaging.version import Version

from tests.repo.tracked import REPOSITORY, tracked_names

PACKAGES = ("protocol", "solver_service", "viewer")
PROJECT = tomllib.loads((REPOSITORY / "pyproject.toml").read_text(encoding="utf-8"))["project"]
LOCK = (REPOSITORY / ".ci" / "requirements.lock").read_text(encoding="utf-8")


def locked() -> dict[str, Requirement]:
    lines = [line for line in LOCK.splitlines() if line and not line.startswith("#")]
    return {canonicalize_name(requirement.name): requirement for requirement in map(Requirement, lines)}


def asked_for() -> Iterator[Requirement]:
    yield from map(Requirement, PROJECT["dependencies"])
    for requirements in PROJECT["optional-dependencies"].values():
        yield from map(Requirement, requirements)


def version_of(requirement: Requirement) -> Version:
    (pin,) = requirement.specifier
    assert pin.operator == "==", requirement
    return Version(pin.version)


def test_every_line_of_the_lock_pins_one_version_and_no_package_twice() -> None:
    lines = [line for line in LOCK.splitlines() if line and not line.startswith("#")]

    assert all(re.match(r"^[a-z0-9-]+==[^ ;]+( ; .+)?$", line) for line in lines)
    assert len(locked()) == len(lines)


def test_the_lock_holds_a_fitting_version_of_every_dependency() -> None:
    pins = locked()
    for requirement in asked_for():
        name = canonicalize_name(requirement.name)
        assert name in pins, f"{name} is not in the lock"
        assert requirement.specifier.contains(version_of(pins[name])), (
            f"{pins[name]} does not fit {requirement}"
        )


def test_the_installed_versions_are_the_locked_ones() -> None:
    from importlib.metadata import PackageNotFoundError, version

    different = {}
    for name, requirement in locked().items():
        if requirement.marker is not None and not requirement.marker.evaluate():
            continue
        try:
            installed = version(name)
        except PackageNotFoundError:
            installed = "not installed"
        if installed != str(version_of(requirement)):
            different[name] = installed

    assert not different


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> zipfile.ZipFile:
    source, folder = tmp_path_factory.mktemp("source"), tmp_path_factory.mktemp("wheel")
    # From a copy of what git knows: a build in the tree would leave folders behind, and would not notice that
    # a file was never added.
    names = tracked_names(*PACKAGES, "pyproject.toml", "README.md", "LICENSE")
    if names is None:
        pytest.skip("this is no git clone, or git is not installed: what a clone would hold is not known")
    for name in names:
        (source / name).parent.mkdir(parents=True, exist_ok=True)
        (source / name).write_bytes((REPOSITORY / name).read_bytes())
    pip = [sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps", "--no-build-isolation", "--no-index"]
    command = [*pip, "--wheel-dir", str(folder), str(source)]
    built = subprocess.run(command, capture_output=True, text=True, timeout=180, check=False)
    assert built.returncode == 0, built.stderr
    (path,) = folder.glob("*.whl")
    return zipfile.ZipFile(path)


def test_the_wheel_holds_every_file_of_the_three_packages(wheel: zipfile.ZipFile) -> None:
    tracked = set(tracked_names(*PACKAGES) or [])
    packed = {name for name in wheel.namelist() if name.split("/")[0] in PACKAGES}

    assert packed == tracked


def test_the_wheel_holds_shaders_cases_and_the_licence(wheel: zipfile.ZipFile) -> None:
    names = wheel.namelist()

    assert any(name.startswith("viewer/render/shaders/") for name in names)
    assert any(name.startswith("solver_service/cases/jacksboro/") for name in names)
    assert any(name.endswith("/LICENSE") for name in names)
    assert not any(name.split("/")[0] in ("tests", "bench", "docs") for name in names)


def test_the_wheel_offers_both_commands(wheel: zipfile.ZipFile) -> None:
    (entry_points,) = (name for name in wheel.namelist() if name.endswith("entry_points.txt"))
    text = wheel.read(entry_points).decode()

    assert "fev-solver = solver_service.cli:main" in text
    assert "fev-viewer = viewer.cli:main" in text
