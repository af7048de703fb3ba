"""Gives the lines that a request writes, that of its access included, the ids of run and token."""

from __future__ import annotations

from starlette.types import ASGIApp, Receive, Scope, Send

from solver_service.logging_setup import log_context


class RequestLog:
    """A layer round the application: each request has a log context of its own, which handlers add to."""

    def __init__(self, app: ASGIApp) -> None:
        """Wrap an application."""
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve one request or stream."""
        with log_context():
            await self._app(scope, receive, send)
