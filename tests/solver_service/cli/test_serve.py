from pathlib import Path

import pytest

import solver_service.web as web


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
    assert "65535" in answer.err
    assert settings == []
