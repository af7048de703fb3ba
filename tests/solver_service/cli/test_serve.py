from pathlib import Path

import pytest

import solver_service.web as web
from solver_service.web.setting_keys import KEYS


@pytest.fixture
def settings(monkeypatch: pytest.MonkeyPatch) -> list[web.ServiceSettings]:
    """What the web layer was asked to serve."""
    asked: list[web.ServiceSettings] = []
    monkeypatch.setattr(web, "serve", asked.append)
    return asked


def test_every_option_reaches_the_service(tmp_path: Path, fev_solver, settings) -> None:
    words = f"""
        serve --host 0.0.0.0 --port 8765
        --data-dir {tmp_path} --token-file {tmp_path}/t --ready-file {tmp_path}/r
        --case a --case b --device cpu --threads 2 --stop-with-stdin --allow-origin https://a.example
    """
    assert fev_solver(*words.split()).code == 0

    assert settings == [
        web.ServiceSettings(
            host="0.0.0.0",
            port=8765,
            data_dir=tmp_path,
            token_file=tmp_path / "t",
            ready_file=tmp_path / "r",
            cases=("a", "b"),
            device="cpu",
            threads=2,
            stop_with_stdin=True,
            allowed_origins=("https://a.example",),
        )
    ]


def test_without_options_the_defaults_of_the_service_hold(fev_solver, settings) -> None:
    assert fev_solver("serve").code == 0

    assert settings == [web.ServiceSettings()]


def test_a_port_out_of_range_is_refused(fev_solver, settings) -> None:
    answer = fev_solver("serve", "--port", "70000")

    assert answer.code == 2
    assert "--port" in answer.err
    assert "70000" in answer.err
    assert "65535" in answer.err
    assert settings == []


def test_a_settings_file_and_the_environment_reach_the_service(
    tmp_path: Path, fev_solver, settings, monkeypatch: pytest.MonkeyPatch
) -> None:
    config = tmp_path / "server.toml"
    config.write_text("port = 1\nthreads = 1\nspare_workers = 0\n")
    monkeypatch.setenv("FEV_SERVE_THREADS", "2")

    assert fev_solver("serve", "--config", config, "--port", "3").code == 0
    assert settings == [web.ServiceSettings(port=3, threads=2, spare_workers=0)]


def test_the_settings_can_be_shown_without_serving(tmp_path: Path, fev_solver, settings) -> None:
    answer = fev_solver("serve", "--show-config", "--port", "8765")

    assert answer.code == 0
    assert "port = 8765  # flag --port" in answer.out.splitlines()
    assert settings == []


def test_a_wrong_settings_file_is_refused_in_one_sentence(tmp_path: Path, fev_solver, settings) -> None:
    config = tmp_path / "server.toml"
    config.write_text("prot = 1\n")

    answer = fev_solver("serve", "--config", config)

    assert answer.code == 2
    assert len(answer.err.splitlines()) == 1
    assert "'prot'" in answer.err
    assert settings == []


def test_every_flag_of_the_settings_is_an_option_of_the_command(fev_solver) -> None:
    options = fev_solver("serve", "--help").out

    assert not [key.flag for key in KEYS if key.flag is not None and f"{key.flag} " not in options]
