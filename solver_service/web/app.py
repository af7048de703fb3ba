"""The web application: REST for scripts, one websocket for viewers, and who may use them."""

from __future__ import annotations

from typing import Annotated, Any

import msgspec
from fastapi import Depends, FastAPI, HTTPException, Request, Response, WebSocket
from fastapi.responses import JSONResponse
from pydantic import BaseModel, Field

from protocol import PROTOCOL_VERSION
from solver_service.errors import ServiceError
from solver_service.runs import RunRegistry
from solver_service.web.auth import Gate
from solver_service.web.error_codes import http_status, wire_code
from solver_service.web.stream import StreamConnection
from solver_service.web.version import SERVER_NAME, server_version


class RunRequest(BaseModel):
    """Body of POST /v1/runs."""

    case: Annotated[str, Field(min_length=1, max_length=256, examples=["jacksboro"])]
    duration: Annotated[float, Field(gt=0, le=1e9, allow_inf_nan=False)] | None = None
    output_interval: Annotated[float, Field(gt=0, le=1e9, allow_inf_nan=False)] | None = None
    device: Annotated[str, Field(pattern=r"^(auto|cpu|cuda(:[0-9]{1,3})?)$")] = "auto"
    paused: bool = False


class RunCreated(BaseModel):
    """Answer of POST /v1/runs."""

    run: str


def create_app(registry: RunRegistry, gate: Gate) -> FastAPI:
    """Make the application.

    Args:
        registry: the runs; opened and closed by the caller.
        gate: who may come in.

    Returns:
        The application; `app.state.connections` is the set of open streams.
    """
    app = FastAPI(title="FEV solver service", version=server_version())
    connections: set[StreamConnection] = set()
    app.state.connections = connections

    def authorised(request: Request) -> None:
        if not gate.accepts_header(request.headers.get("authorization")):
            raise HTTPException(
                401,
                "the Authorization header must carry 'Bearer' and the token",
                {"WWW-Authenticate": "Bearer"},
            )

    @app.exception_handler(ServiceError)
    def tell_service_error(request: Request, error: ServiceError) -> JSONResponse:
        """Answer with the sentence of the error."""
        return JSONResponse({"code": wire_code(error), "detail": str(error)}, http_status(error))

    @app.get("/healthz")
    def healthz() -> dict[str, str]:
        """Whether the service lives."""
        return {"status": "ok"}

    @app.get("/version", dependencies=[Depends(authorised)])
    def version() -> dict[str, str]:
        """Which service this is."""
        return {"server": SERVER_NAME, "version": server_version(), "protocol": PROTOCOL_VERSION}

    @app.get("/v1/status", dependencies=[Depends(authorised)])
    async def status() -> dict[str, Any]:
        """How the service is getting on."""
        return {
            "connections": len(connections),
            "runs": len(registry.tree),
            "workers": len(registry.pool.workers),
            "devices": registry.pool.devices,
            "longest_publish_wait_s": registry.reports.longest_publish_wait_s,
        }

    @app.get("/v1/cases", dependencies=[Depends(authorised)])
    def cases() -> list[dict[str, Any]]:
        """The cases on offer."""
        return [msgspec.to_builtins(case) for case in registry.cases]

    @app.get("/v1/runs", dependencies=[Depends(authorised)])
    async def runs() -> list[dict[str, Any]]:
        """All runs, newest first."""
        return [msgspec.to_builtins(info) for info in registry.infos()]

    @app.post("/v1/runs", dependencies=[Depends(authorised)], status_code=201)
    async def start_run(body: RunRequest) -> RunCreated:
        """Start a run."""
        run = await registry.start_run(
            body.case, body.duration, body.output_interval, body.device, body.paused
        )
        return RunCreated(run=run.run)

    @app.get("/v1/runs/{run}", dependencies=[Depends(authorised)])
    async def run_info(run: str) -> dict[str, Any]:
        """One run."""
        if run not in registry.tree:
            raise HTTPException(404, f"there is no run {run!r}")
        info: dict[str, Any] = msgspec.to_builtins(registry.tree.info(registry.tree.get(run)))
        return info

    @app.websocket("/v1/stream")
    async def stream(websocket: WebSocket) -> None:
        refusal = _refusal(websocket, gate)
        if refusal is not None:
            await websocket.send_denial_response(refusal)
            return
        await websocket.accept(subprotocol=PROTOCOL_VERSION)
        authorised = websocket.headers.get("authorization") is not None
        connection = StreamConnection(websocket, registry, gate, authorised, connections)
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
    if "authorization" in headers and not gate.accepts_header(headers["authorization"]):
        return Response("the token is wrong\n", 401, media_type="text/plain")
    return None
