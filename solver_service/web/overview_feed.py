"""The overview as server-sent events: whole at first, then what has changed, at most twice a second.

Nothing waits in a queue: each watcher remembers what it was sent and gets the difference to what is true
when it has taken that. One that takes nothing for a while is dropped. While nobody watches nothing is done.
"""

from __future__ import annotations

import asyncio
import logging
from collections.abc import AsyncIterator, Awaitable, Callable

import msgspec
from starlette.responses import Response
from starlette.types import Receive, Scope, Send

from solver_service.errors import RunError, ServiceError
from solver_service.web.overview import Overview, changes

LOG = logging.getLogger(__name__)

INTERVAL_S = 0.5
HEARTBEAT_S = 10.0
SEND_TIMEOUT_S = 15.0
MAX_WATCHERS = 16


class OverviewFeed:
    """Collects the overview while somebody watches."""

    def __init__(self, collect: Callable[[], Awaitable[Overview]], interval_s: float = INTERVAL_S) -> None:
        """Nobody watches yet.

        Args:
            collect: gives the overview now.
            interval_s: time between two looks [s].
        """
        self._collect = collect
        self._interval_s = interval_s
        self._latest: Overview = {}
        self._looked = asyncio.Condition()
        self._looker: asyncio.Task[None] | None = None
        self._watchers = 0
        self._is_closed = False
        self.looks = 0

    @property
    def watchers(self) -> int:
        """How many watch."""
        return self._watchers

    async def events(self, still_holds: Callable[[], bool]) -> AsyncIterator[bytes]:
        """Server-sent events for one watcher.

        Args:
            still_holds: whether it may still watch.

        Yields:
            One event: `overview` with what has changed, `end` with the reason, or a comment.

        Raises:
            RunError: too many watch.
        """
        self.admit()
        self._watchers += 1
        try:
            known: Overview = {}
            while not self._is_closed:
                if not still_holds():
                    yield _event("end", "the token was revoked or has expired")
                    return
                latest = await self._next(known)
                news = changes(known, latest)
                known = latest
                yield _event("overview", news) if news is not None else b": nothing new\n\n"
            yield _event("end", "the service is ending")
        finally:
            self._watchers -= 1
            if not self._watchers and self._looker is not None:
                self._looker.cancel()
                self._looker = None

    def admit(self) -> None:
        """Let one more watch.

        Raises:
            RunError: too many watch.
        """
        if self._watchers >= MAX_WATCHERS:
            raise RunError(f"{MAX_WATCHERS} pages watch already; close one")

    async def close(self) -> None:
        """Send everybody home."""
        self._is_closed = True
        async with self._looked:
            self._looked.notify_all()

    async def _next(self, known: Overview) -> Overview:
        """The first overview that is another than the one known; the same after a while without."""
        async with self._looked:
            if self._looker is None:
                self._latest = {}  # what was true when somebody watched last
                self._looker = asyncio.get_running_loop().create_task(self._look())
            try:
                async with asyncio.timeout(HEARTBEAT_S):
                    await self._looked.wait_for(lambda: self._is_closed or self._is_news(known))
            except TimeoutError:
                pass  # a comment then tells that the connection lives
            return self._latest

    def _is_news(self, known: Overview) -> bool:
        return bool(self._latest) and self._latest is not known

    async def _look(self) -> None:
        while True:
            try:
                found = await self._collect()
            except ServiceError as error:
                LOG.warning("the overview cannot be had: %s", error)
            else:
                self.looks += 1
                async with self._looked:
                    if found != self._latest:
                        self._latest = found
                        self._looked.notify_all()
            await asyncio.sleep(self._interval_s)


class EventStream(Response):
    """Sends events until either side ends it, or the other side takes nothing for a while."""

    media_type = "text/event-stream"

    def __init__(self, events: AsyncIterator[bytes]) -> None:
        super().__init__(headers={"Cache-Control": "no-store", "X-Accel-Buffering": "no"})
        del self.headers["content-length"]
        self._events = events

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve one watcher."""
        head = {"type": "http.response.start", "status": self.status_code, "headers": self.raw_headers}
        await send(head)
        sender = asyncio.create_task(self._send_all(send))
        gone = asyncio.create_task(_until_gone(receive))
        try:
            await asyncio.wait((sender, gone), return_when=asyncio.FIRST_COMPLETED)
        finally:
            for task in (sender, gone):
                task.cancel()
            await asyncio.gather(sender, gone, return_exceptions=True)
            await self._events.aclose()  # type: ignore[attr-defined]

    async def _send_all(self, send: Send) -> None:
        async for event in self._events:
            try:
                async with asyncio.timeout(SEND_TIMEOUT_S):
                    await send({"type": "http.response.body", "body": event, "more_body": True})
            except TimeoutError:
                LOG.info("a page that took nothing for %g s was dropped", SEND_TIMEOUT_S)
                return
        await send({"type": "http.response.body", "body": b"", "more_body": False})


async def _until_gone(receive: Receive) -> None:
    while (await receive())["type"] != "http.disconnect":
        pass


def _event(name: str, data: object) -> bytes:
    return b"event: %b\ndata: %b\n\n" % (name.encode(), msgspec.json.encode(data))
