"""Uploads by REST against a real service process, by scope and by quota."""

import socket
import time
from pathlib import Path
from typing import Any

import httpx
import pytest

import protocol
from bench.service_process import ServiceClient, ServiceProcess
from solver_service.web.scopes import Scope
from solver_service.web.token_limits import TokenLimits
from solver_service.web.token_store import TokenStore
from tests.solver_service.uploads.archives import tiny


def headers_of(service: ServiceProcess, scope: Scope, **limits: int) -> dict[str, str]:
    store = TokenStore(service.data_dir)
    token, _ = store.create("Ada", scope, None, TokenLimits(**limits))
    store.close()
    return {"Authorization": f"Bearer {token}"}


def rest(service: ServiceProcess, headers: dict[str, str]) -> httpx.Client:
    return httpx.Client(base_url=service.http, headers=headers, timeout=30.0)


def ended(client: httpx.Client, upload: str) -> dict[str, Any]:
    ends = time.monotonic() + 60.0
    while (facts := client.get(f"/v1/uploads/{upload}").json())["ended"] is None:
        assert time.monotonic() < ends
        time.sleep(0.1)
    return dict(facts)


def test_a_controller_uploads_a_case_that_everybody_sees_and_runs_and_an_operator_removes_it(
    service: ServiceProcess, tmp_path: Path
) -> None:
    controller = rest(service, headers_of(service, Scope.CONTROLLER))
    operator = rest(service, headers_of(service, Scope.OPERATOR))
    with ServiceClient(service) as viewer, controller, operator:
        answer = controller.post("/v1/uploads", content=tiny(tmp_path))
        assert answer.status_code == 202
        facts = ended(controller, answer.json()["upload"])
        assert (facts["status"], facts["case"], facts["label"]) == ("accepted", "tiny", "Ada")
        told = viewer.first(protocol.Notice, lambda notice: "tiny" in notice.text)
        assert told.text == "the case tiny was uploaded by Ada"
        assert "tiny" in [case.name for case in viewer.ask(protocol.ListCases).cases]
        assert {case["name"]: case["uploaded"] for case in controller.get("/v1/cases").json()}["tiny"]
        assert facts in controller.get("/v1/uploads").json()

        run = viewer.do(protocol.StartRun, case="tiny")["run"]
        viewer.first(protocol.RunChanged, lambda e: (e.run.run, e.run.status) == (run, "finished"))
        refused = operator.delete("/v1/cases/tiny")
        assert refused.status_code == 409
        assert f"case tiny is used by {run}" in refused.json()["detail"]
        assert operator.delete(f"/v1/runs/{run}").status_code == 204
        assert controller.delete("/v1/cases/tiny").status_code == 403
        assert operator.delete("/v1/cases/tiny").status_code == 204
        assert "tiny" not in [case.name for case in viewer.ask(protocol.ListCases).cases]
        assert operator.delete("/v1/cases/tiny").status_code == 409


def test_a_case_that_is_refused_says_why(service: ServiceProcess) -> None:
    with rest(service, headers_of(service, Scope.CONTROLLER)) as client:
        upload = client.post("/v1/uploads", content=b"this is no archive").json()["upload"]
        facts = ended(client, upload)
        assert facts["status"] == "refused"
        assert "is no zip archive" in facts["message"]
        assert client.get("/v1/uploads/u0").status_code == 404
        assert client.get("/v1/uploads/..%2F..%2Fetc").status_code == 404


def test_an_upload_counts_as_room_of_its_owner(service: ServiceProcess, tmp_path: Path) -> None:
    with rest(service, headers_of(service, Scope.CONTROLLER, max_disk_bytes=100)) as client:
        answer = client.post("/v1/uploads", content=tiny(tmp_path))
    assert answer.status_code in (403, 429)
    assert "bytes on disk" in answer.json()["detail"]


@pytest.mark.parametrize(("length", "status"), [(str(1 << 40), b"413"), ("-1", b"400"), ("many", b"400")])
def test_a_length_that_is_too_large_or_none_is_refused_before_the_archive_comes(
    service: ServiceProcess, length: str, status: bytes
) -> None:
    token = headers_of(service, Scope.CONTROLLER)["Authorization"]
    head = (
        f"POST /v1/uploads HTTP/1.1\r\nHost: x\r\nAuthorization: {token}\r\nContent-Length: {length}\r\n\r\n"
    )
    host, port = service.http.removeprefix("http://").split(":")
    with socket.create_connection((host, int(port)), timeout=10.0) as client:
        client.sendall(head.encode())
        assert client.recv(65536).split()[1] == status
