"""What the routes really answer is of the types that describe them."""

from typing import Any

import httpx
import msgspec
import pytest

from bench.service_process import ServiceProcess
from protocol import RunInfo
from solver_service.uploads.upload_record import UploadRecord
from solver_service.web.api_types import (
    Health,
    OfferedCase,
    OpenStream,
    Problem,
    Readiness,
    RunCreated,
    ServiceStatus,
    TokenFacts,
    Version,
)
from solver_service.web.scopes import Scope
from tests.solver_service.web.test_token_watch import token_of


@pytest.mark.parametrize(
    ("path", "kind"),
    [
        ("/healthz", Health),
        ("/readyz", Readiness),
        ("/version", Version),
        ("/v1/status", ServiceStatus),
        ("/v1/connections", list[OpenStream]),
        ("/v1/cases", list[OfferedCase]),
        ("/v1/runs", list[RunInfo]),
        ("/v1/uploads", list[UploadRecord]),
        ("/v1/tokens", list[TokenFacts]),
        ("/v1/runs/none", Problem),
    ],
)
def test_an_answer_is_of_its_type(service: ServiceProcess, path: str, kind: Any) -> None:
    headers = {"Authorization": f"Bearer {token_of(service, Scope.ADMIN)[0]}"}
    with httpx.Client(base_url=service.http, headers=headers, timeout=60.0) as client:
        created = client.post("/v1/runs", json={"case": "dam-break", "paused": True})
        run = msgspec.json.decode(created.content, type=RunCreated).run
        msgspec.json.decode(client.get(path).content, type=kind)
        client.post(f"/v1/runs/{run}/stop")
