"""The operator's page: three static files and a stream of events; everything else is done by REST."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from fastapi import APIRouter
from fastapi.responses import Response

from solver_service.errors import StoreError
from solver_service.web.api_answers import text_answer
from solver_service.web.api_examples import EVENTS
from solver_service.web.auth import Access, Gate
from solver_service.web.overview_feed import EventStream, OverviewFeed
from solver_service.web.scopes import Scope

FOLDER = Path(__file__).parent / "page"
FILES = {
    "/": ("index.html", "text/html; charset=utf-8"),
    "/page.css": ("page.css", "text/css; charset=utf-8"),
    "/page.js": ("page.js", "text/javascript; charset=utf-8"),
}
HEADERS = {
    "Content-Security-Policy": "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; "
    "img-src data:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cache-Control": "no-cache",
}
"""The page loads nothing from elsewhere, is shown in no frame, and sends its address to nobody."""


def page_router(feed: OverviewFeed, gate: Gate, needs: Callable[[Scope], Any]) -> APIRouter:
    """The routes of the page.

    Args:
        feed: the overview.
        gate: knows whether a token still holds.
        needs: makes the dependency that lets a scope pass.
    """
    router = APIRouter(tags=["operator"])
    operator = needs(Scope.OPERATOR)

    for path, (name, kind) in FILES.items():
        router.add_api_route(path, _sender(FOLDER / name, kind), include_in_schema=False)

    @router.get(
        "/v1/events",
        response_class=Response,
        responses=text_answer("text/event-stream", EVENTS, 409),
    )
    async def events(access: Access = operator) -> EventStream:
        """The overview as server-sent events: whole at first, then what has changed."""
        feed.admit()

        def still_holds() -> bool:
            try:
                return gate.still_holds(access)
            except StoreError:
                return False

        return EventStream(feed.events(still_holds))

    return router


def _sender(path: Path, kind: str) -> Callable[[], Response]:
    def send() -> Response:
        return Response(path.read_bytes(), headers=HEADERS, media_type=kind)

    return send
