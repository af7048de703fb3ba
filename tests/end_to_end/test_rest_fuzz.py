"""Requests that nobody wrote, made from /openapi.json; the full dose is a command of CONTRIBUTING."""

from collections.abc import Iterator
from typing import Any

import pytest
import schemathesis
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis.errors import Unsatisfiable
from schemathesis import GenerationMode

from bench.service_process import ServiceProcess
from solver_service.web.scopes import Scope
from solver_service.web.token_store import TokenStore
from tests.end_to_end import rest_hooks  # noqa: F401  # its import tells how an archive is sent

EXAMPLES = 3
ENDLESS = "/v1/events"
QUICK = settings(
    max_examples=EXAMPLES,
    deadline=None,
    derandomize=True,
    phases=[Phase.explicit, Phase.generate],
    suppress_health_check=list(HealthCheck),
)


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[ServiceProcess]:
    """A service on which nobody may start anything, so that it is quiet whatever is asked."""
    with ServiceProcess(tmp_path_factory.mktemp("data"), max_runs=0, spare_workers=0) as service:
        yield service


@pytest.mark.parametrize("mode", list(GenerationMode))
def test_whatever_is_asked_is_answered_as_told(service: ServiceProcess, mode: GenerationMode) -> None:
    store = TokenStore(service.data_dir)
    token, _ = store.create("fuzz", Scope.ADMIN, None)
    store.close()
    headers = {"Authorization": f"Bearer {token}"}
    schema = schemathesis.openapi.from_url(f"{service.http}/openapi.json")
    asked = set()
    for found in schema.exclude(path=ENDLESS).get_all_operations():
        operation = found.ok()

        @QUICK
        @given(operation.as_strategy(generation_mode=mode))
        def ask(case: Any) -> None:
            case.call_and_validate(headers=headers)

        try:
            ask()
            asked.add(operation.label)
        except Unsatisfiable:  # nothing about it can be wrong
            assert mode is GenerationMode.NEGATIVE
    assert len(asked) >= (17 if mode is GenerationMode.POSITIVE else 5), asked
