"""The web application: REST for scripts, one websocket for viewers, and who may use them."""

from __future__ import annotations

from dataclasses import asdict
from typing import Annotated, Any

import msgspec
from fastapi import FastAPI, HTTPException, Path, Request, Response, Security, WebSocket
from fastapi.responses import JSONResponse
from fastapi.security import HTTPAuthorizationCredentials, HTTPBearer
from pydantic import BaseModel, ConfigDict, Field

from protocol import PROTOCOL_VERSION, ChannelName, RunInfo
from solver_service.errors import AccessError, ServiceError
from solver_service.logging_setup import tag_log
from solver_service.runs import RunRegistry
from solver_service.uploads.upload_desk import UploadDesk
from solver_service.web import api_examples as examples
from solver_service.web.api_answers import SCHEME, answers, describe, text_answer
from solver_service.web.api_types import (
    Health,
    OfferedCase,
    OpenStream,
    Readiness,
    RunCreated,
    ServiceStatus,
    TokenFacts,
    Version,
)
from solver_service.web.auth import Access, Gate
from solver_service.web.error_codes import http_status, wire_code
from solver_service.web.metrics import CONTENT_TYPE, Metrics, unready_reason
from solver_service.web.operator_page import page_router
from solver_service.web.overview import OverviewSource
from solver_service.web.overview_feed import OverviewFeed
from solver_service.web.quotas import Quotas, owner_of
from solver_service.web.request_log import RequestLog
from solver_service.web.run_actions import action_router
from solver_service.web.scopes import Scope
from solver_service.web.stream import StreamConnection
from solver_service.web.token_store import TokenStore
from solver_service.web.upload_routes import upload_router
from solver_service.web.version import SERVER_NAME, server_version


class RunRequest(BaseModel):
    """Body of POST /v1/runs."""

    model_config = ConfigDict(json_schema_extra={"example": {"case": "jacksboro", "duration": 3600.0}})

    case: Annotated[str, Field(min_length=1, max_length=256)]
    duration: Annotated[float, Field(gt=0, le=1e9, allow_inf_nan=False)] | None = None
    output_interval: Annotated[float, Field(gt=0, le=1e9, allow_inf_nan=False)] | None = None
    device: Annotated[str, Field(pattern=r"^(auto|cpu|cuda(:[0-9]{1,3})?)$")] = "auto"
    paused: bool = False
    channels: Annotated[tuple[ChannelName, ...], Field(max_length=8)] | None = None


def create_app(
    registry: RunRegistry,
    gate: Gate,
    tokens: TokenStore,
    quotas: Quotas,
    desk: UploadDesk,
    store_bytes: int | None = None,
) -> FastAPI:
    """Make the application.

    Args:
        registry: the runs; opened and closed by the caller.
        gate: who may come in.
        tokens: the tokens that an admin looks at and revokes.
        quotas: how much the holder of a token may take.
        desk: takes uploads in.
        store_bytes: budget of the store, for the operator's page.

    Returns:
        The application; `app.state.connections` is the set of open streams, `app.state.accepts` is set while
        new viewers are welcome, `app.state.feed` is the feed of the operator's page,
        `app.state.metrics` what `/metrics` tells.
    """
    app = FastAPI(title="FEV solver service", version=server_version())
    connections: set[StreamConnection] = set()
    app.state.connections = connections
    app.state.accepts = False
    source = OverviewSource(registry, desk, connections, tokens.path.parent, store_bytes)
    app.state.feed = OverviewFeed(source.collect)
    app.state.metrics = Metrics(registry, quotas, connections, tokens.path.parent)
    app.add_middleware(RequestLog)

    bearer = Security(HTTPBearer(scheme_name=SCHEME, auto_error=False))  # for the description alone

    def needs(scope: Scope) -> Any:
        def check(request: Request, _: HTTPAuthorizationCredentials | None = bearer) -> Access:
            access = gate.access_by_header(request.headers.get("authorization"))
            if access is None:
                raise HTTPException(
                    401,
                    "the Authorization header must carry 'Bearer' and a token that holds",
                    {"WWW-Authenticate": "Bearer"},
                )
            tag_log(token=access.token or "", run=request.path_params.get("run", ""))
            if access.scope < scope:
                raise AccessError(f"this needs the scope {scope}; the token has the scope {access.scope}")
            return access

        return Security(check, scopes=[str(scope)])

    describe(app)

    @app.exception_handler(ServiceError)
    def tell_service_error(request: Request, error: ServiceError) -> JSONResponse:
        """Answer with the sentence of the error."""
        return JSONResponse({"code": wire_code(error), "detail": str(error)}, http_status(error))

    @app.get("/healthz", response_model=None, responses=answers(Health, {"status": "ok"}))
    def healthz() -> dict[str, str]:
        """Whether the service lives."""
        return {"status": "ok"}

    not_ready = {"status": "not ready", "reason": "the service is starting or ending"}

    @app.get(
        "/readyz",
        response_model=None,
        responses=answers(Readiness, {"status": "ready"}) | answers(Readiness, not_ready, status=503),
    )
    def readyz(response: Response) -> dict[str, str]:
        """Whether new viewers should come: 200, or 503 with the reason."""
        reason = unready_reason(app.state.accepts, tokens.path.parent)
        if reason is None:
            return {"status": "ready"}
        response.status_code = 503
        return {"status": "not ready", "reason": reason}

    @app.get(
        "/metrics",
        dependencies=[needs(Scope.VIEWER)],
        response_class=Response,
        responses=text_answer("text/plain", examples.METRICS),
    )
    async def metrics() -> Response:
        """All metrics in the text format of Prometheus."""
        return Response(await app.state.metrics.text(), headers={"Content-Type": CONTENT_TYPE})

    @app.get(
        "/version",
        dependencies=[needs(Scope.VIEWER)],
        response_model=None,
        responses=answers(Version, examples.VERSION),
    )
    def version() -> dict[str, str]:
        """Which service this is."""
        return {"server": SERVER_NAME, "version": server_version(), "protocol": PROTOCOL_VERSION}

    @app.get(
        "/v1/connections",
        dependencies=[needs(Scope.OPERATOR)],
        response_model=None,
        responses=answers(list[OpenStream], [examples.STREAM]),
    )
    async def connection_list() -> list[dict[str, Any]]:
        """The open streams, oldest first: who, from where, as what, since when, watching which run."""
        facts = [connection.facts() for connection in connections]
        return sorted(facts, key=lambda fact: (fact["since"], fact["session"]))

    @app.get(
        "/v1/status",
        dependencies=[needs(Scope.VIEWER)],
        response_model=None,
        responses=answers(ServiceStatus, examples.STATUS),
    )
    async def status() -> dict[str, Any]:
        """How the service is getting on."""
        return {
            "connections": len(connections),
            "runs": len(registry.tree),
            "workers": len(registry.pool.workers),
            "devices": registry.pool.devices,
            "longest_publish_wait_s": registry.reports.longest_publish_wait_s,
        }

    @app.get(
        "/v1/cases",
        dependencies=[needs(Scope.VIEWER)],
        response_model=None,
        responses=answers(list[OfferedCase], [examples.CASE]),
    )
    async def cases() -> list[dict[str, Any]]:
        """The cases on offer."""
        uploaded = {case.summary.name for case in desk.cases}
        return [{**msgspec.to_builtins(case), "uploaded": case.name in uploaded} for case in registry.cases]

    @app.get(
        "/v1/runs",
        dependencies=[needs(Scope.VIEWER)],
        response_model=None,
        responses=answers(list[RunInfo], [examples.RUN_INFO]),
    )
    async def runs() -> list[dict[str, Any]]:
        """All runs, newest first."""
        return [msgspec.to_builtins(info) for info in registry.infos()]

    controller = needs(Scope.CONTROLLER)

    @app.post(
        "/v1/runs",
        status_code=201,
        response_model=None,
        responses=answers(RunCreated, {"run": examples.RUN}, 400, 409, 429, 507, status=201),
    )
    async def start_run(body: RunRequest, access: Access = controller) -> dict[str, str]:
        """Start a run of a case from its beginning."""
        async with quotas.start(access, body.case, body.device):
            run = await registry.control.start(
                body.case,
                body.duration,
                body.output_interval,
                body.device,
                body.paused,
                owner_of(access),
                channels=body.channels,
            )
        return {"run": run.run}

    @app.get(
        "/v1/runs/{run}",
        dependencies=[needs(Scope.VIEWER)],
        response_model=None,
        responses=answers(RunInfo, examples.RUN_INFO, 404),
    )
    async def run_info(run: Annotated[str, Path(examples=[examples.RUN])]) -> dict[str, Any]:
        """One run."""
        if run not in registry.tree:
            raise HTTPException(404, f"there is no run {run!r}")
        info: dict[str, Any] = msgspec.to_builtins(registry.tree.info(registry.tree.get(run)))
        return info

    @app.get(
        "/v1/tokens",
        dependencies=[needs(Scope.ADMIN)],
        response_model=None,
        responses=answers(list[TokenFacts], [examples.TOKEN]),
    )
    def token_list() -> list[dict[str, Any]]:
        """The tokens there are, without their secrets; times in seconds since 1970."""
        return [{**asdict(record), "scope": str(record.scope)} for record in tokens.records()]

    @app.delete(
        "/v1/tokens/{token}",
        dependencies=[needs(Scope.ADMIN)],
        response_model=None,
        responses=answers(TokenFacts, {**examples.TOKEN, "revoked": 1700003600.0}, 404),
    )
    def revoke_token(token: Annotated[str, Path(examples=["1f0a2b3c"])]) -> dict[str, Any]:
        """Revoke a token; its connections end within seconds."""
        if token not in {record.id for record in tokens.records()}:
            raise HTTPException(404, f"there is no token {token!r}")
        record = tokens.revoke(token)
        return {**asdict(record), "scope": str(record.scope)}

    app.include_router(upload_router(desk, quotas, needs))
    app.include_router(action_router(registry, quotas, connections, needs))
    app.include_router(page_router(app.state.feed, gate, needs))

    @app.websocket("/v1/stream")
    async def stream(websocket: WebSocket) -> None:
        refusal = _refusal(websocket, gate)
        if refusal is not None:
            await websocket.send_denial_response(refusal)
            return
        await websocket.accept(subprotocol=PROTOCOL_VERSION)
        access = gate.access_by_header(websocket.headers.get("authorization"))
        connection = StreamConnection(websocket, registry, gate, quotas, access, connections)
        connections.add(connection)
        try:
            await connection.serve()
        finally:
            connections.discard(connection)

    return app


def _refusal(websocket: WebSocket, gate: Gate) -> Response | None:
    """Why a connection is refused before it is accepted, or None."""
    headers = websocket.headers
    if not gate.accepts_origin(headers.get("origin"), headers.get("host")):
        return Response("pages of this origin are not served\n", 403, media_type="text/plain")
    if PROTOCOL_VERSION not in websocket.scope.get("subprotocols", []):
        return Response(
            f"the websocket subprotocol {PROTOCOL_VERSION} must be offered\n", 400, media_type="text/plain"
        )
    if "authorization" in headers and gate.access_by_header(headers["authorization"]) is None:
        return Response("the token is wrong\n", 401, media_type="text/plain")
    return None
