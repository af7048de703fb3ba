"""The systemd unit starts what there is: its commands, options and settings exist, and it ends in time."""

import configparser
import shlex
import subprocess
import sys
from pathlib import Path

from solver_service.web.setting_sources import resolve_settings

REPOSITORY = Path(__file__).resolve().parents[2]
UNIT = REPOSITORY / "docker" / "fev-solver.service"
SETTINGS = REPOSITORY / "docker" / "server.toml"


def unit() -> configparser.ConfigParser:
    parser = configparser.ConfigParser(interpolation=None, strict=True)
    parser.optionxform = str  # type: ignore[assignment,method-assign]
    parser.read_string(UNIT.read_text(encoding="utf-8"))
    return parser


def options_of(command: str) -> str:
    answer = subprocess.run(
        [sys.executable, "-m", "solver_service", command, "--help"],
        cwd=REPOSITORY,
        capture_output=True,
        text=True,
        timeout=60,
        check=True,
    )
    return answer.stdout


def test_the_unit_names_commands_and_options_that_exist() -> None:
    service = unit()["Service"]
    for key, command in (("ExecStartPre", "warmup"), ("ExecStart", "serve")):
        program, name, *rest = shlex.split(service[key])
        assert Path(program).name == "fev-solver"
        assert name == command
        known = options_of(name).split()
        options = [word for word in rest if word.startswith("--")]
        assert options
        assert not [option for option in options if option not in known], key
    assert "--no-such-option" not in options_of("serve").split()


def test_the_unit_reads_the_settings_file_whose_example_lies_beside_it() -> None:
    words = shlex.split(unit()["Service"]["ExecStart"])
    assert Path(words[words.index("--config") + 1]).name == SETTINGS.name

    settings = resolve_settings(SETTINGS, {}, {}).settings

    assert settings.port == 8765
    state = Path("/var/lib") / unit()["Service"]["StateDirectory"]
    assert state in settings.data_dir.parents


def test_the_unit_gives_the_service_longer_to_end_than_it_needs_and_leaves_wrong_settings_alone() -> None:
    service = unit()["Service"]
    assert service["KillSignal"] == "SIGTERM"
    assert int(service["TimeoutStopSec"]) > 5
    assert service["RestartPreventExitStatus"] == "2"
    assert service["User"] not in ("", "root")
