"""The one table from what the service raises to what the wire and HTTP say."""

from __future__ import annotations

from protocol import ProtocolError
from solver_service.errors import (
    AccessError,
    CaseError,
    CaseTooLarge,
    DeviceError,
    ModelError,
    QuotaError,
    RunError,
    ServiceError,
    StoreError,
    StoreFull,
    TerrainError,
)

_CODES: dict[type[ServiceError], tuple[str, int]] = {
    AccessError: ("forbidden", 403),
    QuotaError: ("over_quota", 429),
    RunError: ("refused", 409),
    StoreError: ("store_failed", 507),
    StoreFull: ("store_failed", 507),
    DeviceError: ("no_such_device", 422),
    CaseError: ("invalid_case", 422),
    CaseTooLarge: ("too_large", 413),
    TerrainError: ("invalid_case", 422),
    ModelError: ("invalid_case", 422),
}


def wire_code(error: ServiceError | ProtocolError) -> str:
    """The `code` of an `error` message."""
    if isinstance(error, ProtocolError):
        return error.code
    return _CODES.get(type(error), ("failed", 500))[0]


def http_status(error: ServiceError) -> int:
    """The status of an HTTP answer."""
    return _CODES.get(type(error), ("failed", 500))[1]
