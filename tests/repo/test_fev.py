"""./fev: what it finds missing, when it installs, what it refuses, and that an old Python is told so."""

import ast
import os
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import pytest

REPOSITORY = Path(__file__).resolve().parents[2]
SCRIPT = REPOSITORY / "fev"


@pytest.fixture
def fev(fev_script: ModuleType, tmp_path: Path) -> ModuleType:
    """The script as a module whose repository is an empty folder."""
    module = fev_script
    module.ROOT = tmp_path
    module.VENV = tmp_path / ".venv"
    module.STAMP = module.VENV / "fev-stamp"
    module.UNFINISHED = module.VENV / "fev-unfinished"
    module.LOCK = tmp_path / "requirements.lock"
    module.PROJECT = tmp_path / "pyproject.toml"
    module.LOG = tmp_path / ".cache" / "fev-setup.log"
    module.LOCK.write_text("numpy==2.4.6\n")
    module.PROJECT.write_text("[project]\nname = 'x'\n[build-system]\nrequires = []\n")
    module.version_of = lambda python: [3, 11, 7] if python.exists() else []
    return module


def pretend_venv(fev: ModuleType) -> None:
    """What `python -m venv` leaves, as far as fev looks at it."""
    fev.venv_python().parent.mkdir(parents=True, exist_ok=True)
    fev.venv_python().touch()


def run_script(*arguments: str, **options: object) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, str(SCRIPT), *arguments]
    return subprocess.run(command, capture_output=True, text=True, timeout=60, check=False, **options)  # type: ignore[call-overload,no-any-return]


def test_python_3_6_can_read_the_script() -> None:
    ast.parse(SCRIPT.read_text(encoding="utf-8"), feature_version=(3, 6))


def test_an_old_python_without_a_newer_one_beside_it_is_told_so(
    fev: ModuleType, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(sys, "version_info", (3, 9, 18, "final", 0))
    monkeypatch.setenv("PATH", str(tmp_path))

    with pytest.raises(SystemExit, match=r"needs Python 3\.11 or newer, but .* is Python 3\.9\.18"):
        fev.exit_unless_python_is_new_enough()


@pytest.mark.skipif(os.name == "nt", reason="a shell script stands for the newer Python")
def test_an_old_python_hands_over_to_a_newer_one_on_the_path(
    fev: ModuleType, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    broken, newer = tmp_path / "broken" / "python3.13", tmp_path / "good" / "python3.12"
    for path, status in ((broken, 1), (newer, 0)):
        path.parent.mkdir()
        path.write_text(f"#!/bin/sh\nexit {status}\n")
        path.chmod(0o755)
    monkeypatch.setattr(sys, "version_info", (3, 9, 18, "final", 0))
    monkeypatch.setenv("PATH", f"{broken.parent}{os.pathsep}{newer.parent}")
    started: list[str] = []

    def execv(path: str, arguments: list[str]) -> None:
        started.extend(arguments)
        raise SystemExit(0)

    monkeypatch.setattr(os, "execv", execv)

    with pytest.raises(SystemExit):
        fev.exit_unless_python_is_new_enough()
    assert started[:2] == [str(newer), str(SCRIPT)]


@pytest.mark.parametrize("arguments", [("fly",), ("libraries",), ("libraries", "draw", "paint")])
def test_a_wrong_command_gets_one_sentence_and_status_1(arguments: tuple[str, ...]) -> None:
    answer = run_script(*arguments)

    assert answer.returncode == 1
    assert answer.stderr.startswith("fev: ")
    assert answer.stderr.count("\n") == 1


def test_help_names_both_commands_and_sets_up_nothing(tmp_path: Path) -> None:
    answer = run_script("--help", cwd=tmp_path)

    assert answer.returncode == 0
    assert "./fev demo" in answer.stdout
    assert "./fev test" in answer.stdout


def test_no_command_shows_the_help_with_status_2() -> None:
    assert run_script().returncode == 2


@pytest.mark.skipif(
    not sys.platform.startswith("linux"), reason="system libraries are looked for on Linux only"
)
def test_a_missing_library_is_found_missing_and_a_present_one_present(fev: ModuleType) -> None:
    fev.SYSTEM_LIBRARIES = {
        "draw": [("libc.so.6", "libc6"), ("libnowhere.so.77", "libnowhere77"), ("no-tool", "t")]
    }

    assert fev.missing_libraries(["draw"]) == [("libnowhere.so.77", "libnowhere77"), ("no-tool", "t")]


def test_a_mesa_vendor_alone_needs_the_mesa_driver(fev: ModuleType, tmp_path: Path) -> None:
    fev.EGL_VENDORS, fev.MESA_DRIVERS = [f"{tmp_path}/vendor/*.json"], [f"{tmp_path}/dri/swrast_dri.so"]
    (tmp_path / "vendor").mkdir()
    assert not fev.is_present("EGL driver")
    (tmp_path / "vendor" / "50_mesa.json").touch()
    assert fev.is_present("EGL driver")
    assert not fev.is_present("Mesa driver")
    (tmp_path / "dri").mkdir()
    (tmp_path / "dri" / "swrast_dri.so").touch()
    assert fev.is_present("Mesa driver")


def test_a_vendor_driver_needs_no_mesa(fev: ModuleType, tmp_path: Path) -> None:
    fev.EGL_VENDORS, fev.MESA_DRIVERS = [f"{tmp_path}/*.json"], []
    (tmp_path / "10_nvidia.json").touch()

    assert fev.is_present("Mesa driver")


def test_without_leave_to_install_a_missing_driver_stops_and_the_command_is_named(
    fev: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(fev.sys, "platform", "linux")
    fev.SYSTEM_LIBRARIES = {**fev.SYSTEM_LIBRARIES, "draw": [("libEGL.so.77", "libegl77")]}
    fev.install_packages = lambda packages: False
    monkeypatch.setattr(fev.shutil, "which", lambda name: f"/usr/bin/{name}")

    with pytest.raises(
        fev.SetupError, match=r"libEGL\.so\.77 not found: run `sudo apt-get install libegl77`"
    ):
        fev.ensure_libraries(["draw"])


def test_a_browser_that_no_package_brings_keeps_nothing_else_from_being_installed(
    fev: ModuleType, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(fev.sys, "platform", "linux")
    fev.SYSTEM_LIBRARIES = {
        **fev.SYSTEM_LIBRARIES,
        "test": [("no-such-tool", "tool"), ("browser", "chromium-headless-shell")],
    }
    fev.BROWSERS = ("no-such-browser",)
    asked: list[list[str]] = []

    def install(packages: list[str]) -> bool:
        asked.append(packages)
        return packages == ["tool"]

    fev.install_packages = install
    fev.ensure_libraries(["test"])

    assert asked == [["chromium-headless-shell", "tool"], ["tool"]]
    assert "browser" in capsys.readouterr().err


def test_without_the_window_libraries_the_headless_way_stays_open(
    fev: ModuleType, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(fev.sys, "platform", "linux")
    fev.SYSTEM_LIBRARIES = {**fev.SYSTEM_LIBRARIES, "draw": [], "window": [("libxcb-x.so.77", "libxcb-x77")]}
    fev.install_packages = lambda packages: False

    fev.ensure_libraries(["draw", "window"])

    assert "libxcb-x77" in capsys.readouterr().err


def test_a_complete_environment_is_trusted_until_lock_project_python_or_place_change(fev: ModuleType) -> None:
    pretend_venv(fev)
    fev.install_locked = lambda: None
    fev.fill_venv()
    assert fev.is_ready()

    lock = fev.LOCK.read_text()
    fev.LOCK.write_text(lock.replace("2.4.6", "2.4.7"))
    assert not fev.is_ready()
    fev.LOCK.write_text(lock)
    assert fev.is_ready()
    fev.version_of = lambda python: [3, 12, 1]
    assert not fev.is_ready()


def test_an_environment_without_a_stamp_is_not_trusted(fev: ModuleType) -> None:
    pretend_venv(fev)

    assert not fev.is_ready()


def test_a_failed_installation_leaves_nothing_behind(
    fev: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    def run_logged(command: list[str], environment: dict[str, str] | None = None) -> int:
        if "venv" in command:
            pretend_venv(fev)
            return 0
        fev.LOG.parent.mkdir(exist_ok=True)
        fev.LOG.write_text("Collecting numpy\nERROR: Could not install packages: No space left on device\n")
        return 1

    fev.run_logged = run_logged

    with pytest.raises(fev.SetupError, match="No space left on device"):
        fev.fill_venv()
    assert not fev.VENV.exists()


def test_without_a_network_the_reason_is_named(fev: ModuleType) -> None:
    fev.LOG.parent.mkdir()
    fev.LOG.write_text(
        "WARNING: Retrying (Retry(total=0)) after connection broken by 'SSLError(...)': /simple/numpy/\n"
        "ERROR: Could not find a version that satisfies the requirement numpy==2.4.6 (from versions: none)\n"
        "ERROR: No matching distribution found for numpy==2.4.6\n"
    )

    assert fev.last_words() == "the package index cannot be reached: SSLError"


def test_an_installation_that_was_killed_is_begun_anew(fev: ModuleType) -> None:
    pretend_venv(fev)
    fev.STAMP.write_text(fev.expected_stamp())
    fev.UNFINISHED.touch()
    made: list[str] = []

    def make_venv() -> None:
        made.append("venv")
        fev.shutil.rmtree(fev.VENV)
        pretend_venv(fev)

    fev.make_venv, fev.install_locked = make_venv, lambda: None
    assert not fev.is_ready()
    fev.fill_venv()

    assert made == ["venv"]
    assert fev.is_ready()


def test_an_update_that_fails_keeps_the_old_environment_but_does_not_trust_it(fev: ModuleType) -> None:
    pretend_venv(fev)

    def fail() -> None:
        raise fev.SetupError("pip failed")

    fev.install_locked = fail
    with pytest.raises(fev.SetupError):
        fev.fill_venv()

    assert fev.venv_python().exists()
    assert not fev.is_ready()


def test_a_full_disk_is_noticed_before_anything_is_written(
    fev: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(fev.shutil, "disk_usage", lambda folder: type("Usage", (), {"free": 10_000_000})())

    with pytest.raises(fev.SetupError, match=r"needs 2\.5 GB, but only 0\.0 GB are free"):
        fev.fill_venv()
    assert not fev.VENV.exists()


@pytest.mark.skipif(os.name == "nt", reason="apt-get is for Debian")
def test_apt_updates_its_lists_first_and_asks_no_question(
    fev: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(os, "geteuid", lambda: 0)
    monkeypatch.setattr(fev.shutil, "which", lambda name: f"/usr/bin/{name}")
    calls: list[tuple[list[str], str]] = []

    def run_logged(command: list[str], environment: dict[str, str]) -> int:
        calls.append((command, environment["DEBIAN_FRONTEND"]))
        return 0

    fev.run_logged = run_logged

    assert fev.install_packages(["libegl1"])
    assert [command[3] for command, _ in calls] == ["update", "install"]
    assert calls[1][0][-1] == "libegl1"
    assert "-y" in calls[1][0]
    assert {frontend for _, frontend in calls} == {"noninteractive"}


@pytest.mark.skipif(os.name == "nt", reason="closing a file descriptor of a child is done with the shell")
def test_a_closed_standard_input_is_no_obstacle(tmp_path: Path) -> None:
    command = f'exec "{sys.executable}" "{SCRIPT}" --help <&-'
    answer = subprocess.run(["sh", "-c", command], cwd=tmp_path, capture_output=True, text=True, check=False)

    assert answer.returncode == 0, answer.stderr
