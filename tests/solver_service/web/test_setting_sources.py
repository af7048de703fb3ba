import re
import tomllib
from pathlib import Path

import pytest

from solver_service.errors import ServeError
from solver_service.web import ServiceSettings
from solver_service.web.setting_keys import KEYS
from solver_service.web.setting_sources import reference_table, resolve_settings, settings_text

REPOSITORY = Path(__file__).resolve().parents[3]
PAGE = REPOSITORY / "docs" / "reference" / "server_settings.md"


def written(folder: Path, text: str) -> Path:
    path = folder / "server.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_a_flag_wins_over_the_environment_and_the_environment_over_the_file(tmp_path: Path) -> None:
    config = written(tmp_path, 'host = "10.0.0.1"\nport = 1\nspare_workers = 2\n')
    environment = {"FEV_SERVE_PORT": "2", "FEV_SERVE_SPARE_WORKERS": "3", "FEV_DATA_HOME": "elsewhere"}

    resolved = resolve_settings(config, environment, {"port": 4, "host": None})

    assert resolved.settings == ServiceSettings(host="10.0.0.1", port=4, spare_workers=3)
    assert resolved.origins["host"] == f"file {config}"
    assert resolved.origins["port"] == "flag --port"
    assert resolved.origins["spare_workers"] == "environment FEV_SERVE_SPARE_WORKERS"
    assert resolved.origins["device"] == "default"


def test_without_any_source_the_defaults_hold() -> None:
    assert resolve_settings(None, {}, {}).settings == ServiceSettings()


def test_the_environment_may_name_the_file_and_an_option_another(tmp_path: Path) -> None:
    config = written(tmp_path, "port = 7\n")
    variables = {"FEV_SERVE_CONFIG": str(config)}

    assert resolve_settings(None, variables, {}).settings.port == 7
    assert resolve_settings(config, {"FEV_SERVE_CONFIG": "/nowhere"}, {}).settings.port == 7


def test_paths_of_a_file_are_relative_to_its_folder(tmp_path: Path) -> None:
    config = written(tmp_path, 'data_dir = "runs"\ntoken_file = "/run/token"\n')

    settings = resolve_settings(config, {"FEV_SERVE_READY_FILE": "ready"}, {}).settings

    assert settings.data_dir == tmp_path / "runs"
    assert settings.token_file == Path("/run/token")
    assert settings.ready_file == Path("ready")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("port = 70000", ["server.toml", "port", "70000", "0 to 65535"]),
        ('device = "tpu"', ["server.toml", "device", "'tpu'", "cuda:N"]),
        ("prot = 8765", ["server.toml", "'prot'", "names no setting", "port"]),
        ("[server]\nport = 1", ["server.toml", "'server'", "names no setting"]),
        ("port = ", ["server.toml", "is not TOML"]),
    ],
)
def test_a_wrong_file_is_refused_with_its_name_key_and_value(
    tmp_path: Path, text: str, words: list[str]
) -> None:
    with pytest.raises(ServeError) as refusal:
        resolve_settings(written(tmp_path, text), {}, {})
    assert all(word in str(refusal.value) for word in words), str(refusal.value)


def test_a_file_that_is_not_there_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ServeError, match=r"settings file .*none\.toml cannot be read"):
        resolve_settings(tmp_path / "none.toml", {}, {})


@pytest.mark.parametrize(
    ("variable", "text", "words"),
    [
        ("FEV_SERVE_PORT", "http", ["port", "FEV_SERVE_PORT", "'http'", "0 to 65535"]),
        ("FEV_SERVE_PROT", "1", ["FEV_SERVE_PROT", "names no setting"]),
        ("FEV_SERVE_port", "1", ["FEV_SERVE_port", "names no setting"]),
    ],
)
def test_a_wrong_variable_is_refused(variable: str, text: str, words: list[str]) -> None:
    with pytest.raises(ServeError) as refusal:
        resolve_settings(None, {variable: text}, {})
    assert all(word in str(refusal.value) for word in words), str(refusal.value)


def test_a_wrong_flag_is_refused_although_the_file_is_right(tmp_path: Path) -> None:
    with pytest.raises(ServeError, match=r"threads of --threads is 0; a whole number from 1 to 4096"):
        resolve_settings(written(tmp_path, "threads = 2"), {}, {"threads": 0})


def test_what_is_shown_is_a_settings_file_that_gives_the_same(tmp_path: Path) -> None:
    resolved = resolve_settings(
        None, {}, {"data_dir": tmp_path / 'a "quoted" \\ folder', "cases": ("a", "b"), "threads": 3}
    )
    shown = settings_text(resolved)

    assert "threads = 3  # flag --threads" in shown
    assert "# store_bytes is not set  # default" in shown
    assert resolve_settings(written(tmp_path, shown), {}, {}).settings == resolved.settings
    assert set(tomllib.loads(shown)) == {
        key.name for key in KEYS if getattr(resolved.settings, key.name) is not None
    }


def test_the_page_of_the_settings_has_the_table_of_the_code() -> None:
    page = PAGE.read_text(encoding="utf-8")
    match = re.search(r"<!-- begin settings -->\n\n(.*?)\n<!-- end settings -->", page, re.DOTALL)
    assert match is not None
    assert match[1] == reference_table()
