"""What REST answers, as types: the schemas of OpenAPI are made of them."""

from __future__ import annotations

from typing import Literal

import msgspec

from protocol import CaseSummary
from solver_service.web.token_limits import TokenLimits


class Problem(msgspec.Struct):
    """Why a request was refused; `detail` is a sentence for people, programs look at `code`."""

    code: str
    detail: str


class Health(msgspec.Struct):
    """The process lives."""

    status: Literal["ok"]


class Readiness(msgspec.Struct):
    """Whether new viewers should come, and if not why."""

    status: Literal["ready", "not ready"]
    reason: str = ""


class Version(msgspec.Struct):
    """Which service this is, and which protocol its stream speaks."""

    server: str
    version: str
    protocol: str


class ServiceStatus(msgspec.Struct):
    """How the service is getting on."""

    connections: int
    runs: int
    workers: int
    devices: tuple[str, ...]
    longest_publish_wait_s: float


class OpenStream(msgspec.Struct):
    """An open stream: who, from where, as what, since when [s since 1970], watching which run."""

    session: str
    client: str
    address: str
    token: str | None
    scope: str | None
    run: str | None
    since: float


class OfferedCase(CaseSummary, frozen=True):
    """A case in a few words, and whether it was uploaded."""

    uploaded: bool = False


class RunCreated(msgspec.Struct):
    """The id of a new run."""

    run: str


class TokenFacts(msgspec.Struct):
    """A token without its secret; times in seconds since 1970."""

    id: str
    label: str
    scope: Literal["viewer", "controller", "operator", "admin"]
    created: float
    expires: float | None
    revoked: float | None
    limits: TokenLimits
