"""The images install what ./fev installs: same libraries, same versions, no steps of their own."""

import re
import tomllib
from fnmatch import fnmatch
from pathlib import Path
from types import ModuleType

import pytest
import yaml

REPOSITORY = Path(__file__).resolve().parents[2]
DOCKER = REPOSITORY / "docker"
DOCKERFILES = sorted(DOCKER.glob("*.Dockerfile"))
PROJECT = tomllib.loads((REPOSITORY / "pyproject.toml").read_text(encoding="utf-8"))["project"]


def instructions(path: Path) -> list[str]:
    """The instructions of a Dockerfile, continued lines joined, comments left out."""
    lines = [
        line for line in path.read_text(encoding="utf-8").splitlines() if not line.lstrip().startswith("#")
    ]
    return [line for line in re.sub(r"\\\n\s*", "", "\n".join(lines)).splitlines() if line.strip()]


def test_there_is_a_service_image_and_a_headless_viewer_image() -> None:
    assert [path.name for path in DOCKERFILES] == ["service.Dockerfile", "viewer_headless.Dockerfile"]


@pytest.mark.parametrize("path", DOCKERFILES, ids=lambda path: path.name)
def test_an_image_names_no_system_package_but_python(path: Path) -> None:
    installed = re.findall(r"apt-get install ([^&|;]*)", "\n".join(instructions(path)))
    packages = {word for words in installed for word in words.split() if not word.startswith("-")}

    assert packages == {"python3", "python3-venv"}


@pytest.mark.parametrize(
    ("name", "group", "extra"), [("service", "solve", "solver"), ("viewer_headless", "draw", "viewer")]
)
def test_an_image_takes_its_libraries_from_fev_and_its_versions_from_the_lock(
    fev_script: ModuleType, name: str, group: str, extra: str
) -> None:
    text = "\n".join(instructions(DOCKER / f"{name}.Dockerfile"))
    pip_lines = re.findall(r"pip install [^&]*", text)

    assert re.findall(r"fev libraries ([a-z ]+?) *&&", text) == [group]
    assert group in fev_script.SYSTEM_LIBRARIES
    assert extra in PROJECT["optional-dependencies"]
    assert f'".[{extra}]"' in text
    assert len(pip_lines) == 2
    assert all("-c .ci/requirements.lock" in line for line in pip_lines)


@pytest.mark.parametrize("path", DOCKERFILES, ids=lambda path: path.name)
def test_an_image_does_not_run_as_root(path: Path) -> None:
    users = [line.split()[1] for line in instructions(path) if line.startswith("USER ")]

    assert users
    assert users[-1] not in ("0", "root")


@pytest.mark.parametrize("path", DOCKERFILES, ids=lambda path: path.name)
def test_what_an_image_copies_exists_and_is_let_through(path: Path) -> None:
    ignore_file = path.with_name(f"{path.name}.dockerignore").read_text(encoding="utf-8").splitlines()
    let_through = [line[1:] for line in ignore_file if line.startswith("!")]
    sources = [word for line in instructions(path) if line.startswith("COPY ") for word in line.split()[1:-1]]

    assert sources
    for source in sources:
        assert (REPOSITORY / source).exists(), source
        assert any(fnmatch(source, pattern) for pattern in let_through), f"{source} is kept out of the build"


def test_compose_builds_both_images_with_limits_and_a_kept_volume() -> None:
    compose = yaml.safe_load((DOCKER / "compose.yaml").read_text(encoding="utf-8"))
    built = {service["build"]["dockerfile"] for service in compose["services"].values()}

    assert built == {f"docker/{path.name}" for path in DOCKERFILES}
    for service in compose["services"].values():
        assert {"cpus", "memory"} <= set(service["deploy"]["resources"]["limits"])
        for mount in service["volumes"]:
            assert mount.split(":")[0] in compose["volumes"]
    service = compose["services"]["service"]
    assert all(port.startswith("127.0.0.1:") for port in service["ports"])
    assert "service_healthy" in str(compose["services"]["viewer"]["depends_on"])
