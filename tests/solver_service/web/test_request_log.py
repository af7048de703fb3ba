"""What a request adds stays with it; through a service in `test_logging_setup`."""

import asyncio
import json
import logging

from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import PlainTextResponse
from starlette.routing import Route

from solver_service.logging_setup import LineFormatter, tag_log
from solver_service.web.request_log import RequestLog


async def ids_told_by(app: RequestLog, path: str) -> dict[str, str]:
    """The ids of a line that is written while the answer goes out, as that of the access is."""
    lines: list[dict[str, str]] = []

    async def send(message: object) -> None:
        record = logging.LogRecord("uvicorn.access", logging.INFO, __file__, 1, "x", (), None)
        lines.append(json.loads(LineFormatter(True).format(record)))

    async def receive() -> dict[str, object]:
        return {"type": "http.request", "body": b"", "more_body": False}

    await app(
        {"type": "http", "method": "GET", "path": path, "query_string": b"", "headers": []}, receive, send
    )
    return {name: lines[0][name] for name in ("session", "run", "token") if name in lines[0]}


def test_the_ids_of_one_request_are_not_those_of_another() -> None:
    async def tagged(request: Request) -> PlainTextResponse:
        tag_log(run=request.path_params["run"])
        await asyncio.sleep(0.01)
        return PlainTextResponse("")

    async def plain(request: Request) -> PlainTextResponse:
        await asyncio.sleep(0.005)
        return PlainTextResponse("")

    app = RequestLog(Starlette(routes=[Route("/runs/{run}", tagged), Route("/plain", plain)]))

    async def ask() -> None:
        found = await asyncio.gather(
            ids_told_by(app, "/runs/r1"), ids_told_by(app, "/plain"), ids_told_by(app, "/runs/r2")
        )
        assert found == [{"run": "r1"}, {}, {"run": "r2"}]

    asyncio.run(ask())
