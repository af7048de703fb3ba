"""Log lines by themselves, and those of a real service with its workers."""

import json
import logging
import re
import subprocess
import sys
from pathlib import Path

import httpx
import pytest
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect

import protocol
from bench.service_process import ServiceClient, ServiceProcess
from solver_service.logging_setup import CONCEALED, LineFormatter, conceal, log_context, tag_log
from solver_service.web.scopes import Scope
from solver_service.web.token_store import TokenStore
from tests.end_to_end.dam_break import write_dam_break

TIME = re.compile(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z")


def line(message: str, *, as_json: bool = True, name: str = "solver_service.x", **extra: str) -> str:
    record = logging.LogRecord(name, logging.WARNING, __file__, 1, message, (), None)
    vars(record).update(extra)
    return LineFormatter(as_json, lambda: {"run": "of the process"}).format(record)


def test_a_json_line_has_time_level_logger_message_and_the_ids_that_hold() -> None:
    with log_context(session="s1"):
        with log_context(run="r1"):
            tag_log(token="aabb")
            found = json.loads(line("words"))
        outer = json.loads(line("words"))
    assert TIME.fullmatch(found.pop("time"))
    assert found == {
        "level": "warning",
        "logger": "solver_service.x",
        "message": "words",
        "session": "s1",
        "run": "r1",
        "token": "aabb",
    }
    assert (outer["session"], outer["run"]) == ("s1", "of the process")
    assert "token" not in outer
    assert json.loads(line("words", run="r2"))["run"] == "r2"


def test_a_text_line_is_one_line_whatever_it_tells() -> None:
    found = line("a\nFORGED\x1b[2J\u2028b", as_json=False, session="s\n1")
    assert len(found.splitlines()) == 1
    assert found.isprintable()
    assert " WARNING solver_service.x: a\\u000aFORGED" in found
    assert found.endswith("[session=s\\u000a1 run=of the process]")


@pytest.mark.parametrize("as_json", [True, False])
def test_a_traceback_belongs_to_its_line(as_json: bool) -> None:
    try:
        raise ValueError("sixteen tons")
    except ValueError:
        record = logging.LogRecord("x", logging.ERROR, __file__, 1, "it broke", (), sys.exc_info())
    text = LineFormatter(as_json).format(record)
    if as_json:
        assert "ValueError: sixteen tons" in json.loads(text)["traceback"]
    else:
        head, *trace = text.splitlines()
        assert head.endswith("it broke")
        assert all(part.startswith("    ") for part in trace)
        assert trace[-1] == "    ValueError: sixteen tons"


@pytest.mark.parametrize("as_json", [True, False])
def test_no_secret_is_written(as_json: bool) -> None:
    conceal("open-sesame-open-sesame")
    told = line("open-sesame-open-sesame fev-0a1b2c3d-" + "x" * 43, as_json=as_json)
    assert "sesame" not in told
    assert "xxx" not in told
    assert "fev-0a1b2c3d-" in told  # the id may be told
    assert told.count(CONCEALED) == 2
    access = line('"GET /v1/runs?token=abc&x HTTP/1.1" 401', as_json=as_json, name="uvicorn.access")
    assert "abc" not in access
    assert "/v1/runs" in access


def test_every_line_of_a_service_and_its_workers_is_json_with_ids_and_without_tokens(tmp_path: Path) -> None:
    case = str(write_dam_break(tmp_path / "dam-break"))
    told = tmp_path / "log"
    data = tmp_path / "data"
    store = TokenStore(data)
    token, record = store.create("guest", Scope.OPERATOR, None)
    store.close()
    options = {"cases": [case], "threads": 1, "log_format": "json", "log_level": "debug"}
    with told.open("wb") as log, ServiceProcess(data, stderr=log, **options) as service:
        wrong = "wrong-" + "w" * 40
        for path in ("/v1/runs", f"/v1/runs?token={service.token}", f"/healthz?{token}"):
            httpx.get(service.http + path, headers={"Authorization": f"Bearer {wrong}"})
        httpx.get(f"{service.http}/v1/runs/r%0a9", headers={"Authorization": f"Bearer {token}"})
        with pytest.raises(InvalidStatus):
            connect(
                f"{service.url}?token={token}",
                subprotocols=[protocol.PROTOCOL_VERSION],  # type: ignore[list-item]
                additional_headers={"Authorization": f"Bearer {wrong}"},
                compression=None,
            )
        guest = ServiceProcess(data)
        guest.url, guest.http, guest.token = service.url, service.http, token
        with ServiceClient(guest) as client:
            session = client.session.welcome.session  # type: ignore[union-attr]
            run = client.do(protocol.StartRun, case="dam-break", duration=20.0)["run"]
            client.first(protocol.RunChanged, lambda m: m.run.run == run and m.run.status == "finished")
            client.ask(protocol.ResumeRun, run=run)
        secrets = [service.token, token, token[13:], wrong]

    text = told.read_text()
    assert not [secret for secret in secrets if secret in text]
    lines = [json.loads(each) for each in text.splitlines()]
    assert all({"time", "level", "logger", "message"} <= set(each) for each in lines)
    by_worker = [each for each in lines if each["logger"].startswith("solver_service.runs.run_loop")]
    assert [each["run"] for each in by_worker if each["message"].startswith("computing on cpu")] == [run]
    refusal = [each for each in lines if each["message"].startswith("resume_run is refused")]
    assert [(each["session"], each["run"], each["token"]) for each in refusal] == [(session, run, record.id)]
    access = [each for each in lines if each["logger"] == "uvicorn.access"]
    assert {"404", "401", "200"} <= {each["message"].split()[-1] for each in access}
    assert [each["token"] for each in access if each["message"].endswith("404")] == [record.id]
    assert any(each["logger"] == "uvicorn.error" and "/v1/stream" in each["message"] for each in lines)


def test_the_command_takes_form_and_level(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "solver_service", "serve", "--log-format", "xml"]
    answer = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert answer.returncode == 2
    assert "log_format of --log-format is 'xml'; text or json is allowed" in answer.stderr
