import pytest

from protocol.errors import ProtocolError
from solver_service.errors import (
    AccessError,
    CaseError,
    DeviceError,
    QuotaError,
    RunError,
    ServeError,
    StoreError,
    StoreFull,
    TerrainError,
)
from solver_service.web.error_codes import http_status, wire_code


@pytest.mark.parametrize(
    ("error", "code", "status"),
    [
        (AccessError("x"), "forbidden", 403),
        (QuotaError("max_runs", "x"), "over_quota", 429),
        (RunError("x"), "refused", 409),
        (StoreError("x"), "store_failed", 507),
        (StoreFull("x"), "store_failed", 507),
        (DeviceError("x"), "no_such_device", 422),
        (CaseError("x"), "invalid_case", 422),
        (TerrainError("x"), "invalid_case", 422),
        (ServeError("x"), "failed", 500),
    ],
    ids=lambda value: type(value).__name__ if isinstance(value, Exception) else None,
)
def test_the_wire_and_http_say_the_same_of_an_error(error: Exception, code: str, status: int) -> None:
    assert wire_code(error) == code
    assert http_status(error) == status


def test_an_error_of_the_protocol_keeps_its_own_code() -> None:
    for kind in ProtocolError.__subclasses__():
        if isinstance(getattr(kind, "code", None), str):
            assert wire_code(kind.__new__(kind)) == kind.code
