"""The program in one piece against the tiny service; the local service is tried in `tests/end_to_end`."""

import json
import time
from pathlib import Path

import pytest

from tests.viewer.tiny_service import TOKEN, TinyService
from viewer.app.endpoint import Endpoint
from viewer.app.program import ViewerJob, fly_headless
from viewer.commands import StartRun
from viewer.errors import ViewerError


def job(service: TinyService, token: str = TOKEN, case: str = "tiny") -> ViewerJob:
    address = f"ws://127.0.0.1:{service.port}"
    return ViewerJob(Endpoint(address, token), StartRun(case), time.monotonic())


def test_a_script_flies_with_an_address_without_a_path(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    service = TinyService()
    script = tmp_path / "script.json"
    script.write_text('[{"until_time": 100, "command": "Seek", "time": 50, "picture": "a.png"}]')
    summary = fly_headless(job(service), tmp_path / "out", script)
    service.close()

    assert summary.pictures == ["a.png"]
    assert json.loads((tmp_path / "out" / "summary.json").read_text())["case"] == "tiny"
    assert "Tiny valley" in capsys.readouterr().out


def test_a_refused_token_ends_the_flight(tmp_path: Path) -> None:
    service = TinyService()
    with pytest.raises(ViewerError, match="wrong token"):
        fly_headless(job(service, token="other"), tmp_path / "out", None)
    service.close()

    assert not (tmp_path / "out" / "summary.json").exists()


def test_a_wrong_script_is_told_before_anything_is_started(tmp_path: Path) -> None:
    service = TinyService()
    with pytest.raises(ViewerError, match=r"missing\.toml"):
        fly_headless(job(service), tmp_path / "out", tmp_path / "missing.toml")
    service.close()

    assert service.hellos == []
    assert not (tmp_path / "out").exists()
