"""Viewers without pictures in a process of their own: fast, paced, over a slow link, and dead ones.

`Crowd` starts the process (`python -m bench.crowd`) and reads what it counts, two times a second.
"""

from __future__ import annotations

import asyncio
import json
import subprocess
import sys
import threading
import time
from collections import Counter
from contextlib import AsyncExitStack
from dataclasses import asdict, dataclass
from types import TracebackType
from typing import Any
from urllib.parse import urlsplit

from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed

import protocol
from bench.service_process import ServiceProcess
from bench.shaped_link import Link, shaped_link

REPORT_S = 0.5
PATIENCE_S = 60.0


@dataclass(frozen=True)
class Viewer:
    """How one viewer behaves.

    Attributes:
        name: tells it from the others.
        frames_per_s: frames it pays for a second; None for each at once.
        reads: whether it ever reads again once it has its first frame.
        credit: frames it may be sent ahead.
        link: the link it comes over; None for the bare one.
    """

    name: str
    frames_per_s: float | None = None
    reads: bool = True
    credit: int = protocol.limits.DEFAULT_CREDIT
    link: Link | None = None


@dataclass(frozen=True)
class Counted:
    """Frames of each viewer up to a moment (`time.monotonic`)."""

    clock: float
    frames: dict[str, int]


class Crowd:
    """Viewers that follow one run live until the `with` block ends.

    Args:
        service: where to connect.
        run: the run they watch.
        viewers: who they are.
    """

    def __init__(self, service: ServiceProcess, run: str, viewers: list[Viewer]) -> None:
        self._told = json.dumps(
            {
                "url": service.url,
                "token": service.token,
                "run": run,
                "viewers": [asdict(viewer) for viewer in viewers],
            }
        )
        self._names = [viewer.name for viewer in viewers]
        self._counts: dict[str, Any] = {}
        self._news = threading.Condition()

    def __enter__(self) -> Crowd:
        """Start them and wait until each has had a frame."""
        command = [sys.executable, "-m", "bench.crowd"]
        self._process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, bufsize=1
        )
        assert self._process.stdin is not None
        self._process.stdin.write(self._told + "\n")
        self._listener = threading.Thread(target=self._listen, daemon=True)
        self._listener.start()
        with self._news:
            if not self._news.wait_for(lambda: all(self.frames(name) for name in self._names), PATIENCE_S):
                raise TimeoutError(f"not every viewer has had a frame: {self._counts}")
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """End them."""
        assert self._process.stdin is not None
        self._process.stdin.close()
        try:
            self._process.wait(PATIENCE_S)
        finally:
            self._process.kill()
            self._listener.join()

    def frames(self, name: str) -> int:
        """Frames that a viewer has had so far."""
        return int(self._counts.get("frames", {}).get(name, 0))

    @property
    def cut(self) -> dict[str, float]:
        """Viewers whose connection the service has ended, and when (`time.monotonic`)."""
        return dict(self._counts.get("cut", {}))

    @property
    def sessions(self) -> dict[str, str]:
        """The name that the service gave each viewer's session."""
        return dict(self._counts.get("sessions", {}))

    def counted(self) -> Counted:
        """What has been counted so far, at the next report."""
        with self._news:
            self._news.wait(PATIENCE_S)
            return Counted(self._counts["clock"], dict(self._counts["frames"]))

    def rates_since(self, since: Counted) -> dict[str, float]:
        """Frames a second of each viewer since then."""
        now = self.counted()
        seconds = now.clock - since.clock
        return {name: (now.frames[name] - since.frames[name]) / seconds for name in self._names}

    def _listen(self) -> None:
        assert self._process.stdout is not None
        with self._process.stdout as lines:
            for line in lines:
                with self._news:
                    self._counts = json.loads(line)
                    self._news.notify_all()


class _Seats:
    """The viewers inside their process."""

    def __init__(self, url: str, token: str, run: str) -> None:
        self._url = url
        self._token = token
        self._run = run
        self._frames: Counter[str] = Counter()
        self._cut: dict[str, float] = {}
        self._sessions: dict[str, str] = {}

    async def watch(self, viewer: Viewer) -> None:
        """Be one viewer."""
        async with AsyncExitStack() as stack:
            url = self._url
            if viewer.link is not None:
                place = urlsplit(self._url)
                assert place.hostname is not None
                assert place.port is not None
                port = await stack.enter_async_context(shaped_link(place.hostname, place.port, viewer.link))
                url = place._replace(netloc=f"127.0.0.1:{port}").geturl()
            connection = await stack.enter_async_context(
                connect(
                    url,
                    subprotocols=[protocol.PROTOCOL_VERSION],  # type: ignore[list-item]
                    additional_headers={"Authorization": f"Bearer {self._token}"},
                    compression=None,
                    max_size=protocol.limits.OUTBOUND_MAX_BYTES,
                    max_queue=2,
                    ping_interval=None,
                    open_timeout=PATIENCE_S,
                    close_timeout=0.5,
                )
            )
            try:
                await self._follow(connection, viewer)
            except ConnectionClosed:
                self._cut[viewer.name] = time.monotonic()

    async def _follow(self, connection: ClientConnection, viewer: Viewer) -> None:
        session = protocol.ClientSession(f"crowd {viewer.name}")
        await connection.send(session.open(None))
        asked = False
        due = time.monotonic()
        async for data in connection:
            assert isinstance(data, bytes)
            for event in session.receive(data):
                if isinstance(event, protocol.Welcome) and not asked:
                    asked = True
                    self._sessions[viewer.name] = event.session
                    command = protocol.Subscribe(session.next_id(), self._run, 0, "live", viewer.credit)
                    await connection.send(session.send(command))
                elif isinstance(event, protocol.Frame):
                    self._frames[viewer.name] += 1
                    if not viewer.reads:
                        connection.transport.pause_reading()
                        await asyncio.Event().wait()
                    if viewer.frames_per_s is not None:
                        due = max(due + 1.0 / viewer.frames_per_s, time.monotonic())
                        await asyncio.sleep(due - time.monotonic())
                    await connection.send(session.send(protocol.Credit(1)))

    async def report(self) -> None:
        """Tell the counts for ever."""
        while True:
            told = {
                "clock": time.monotonic(),
                "frames": self._frames,
                "cut": self._cut,
                "sessions": self._sessions,
            }
            print(json.dumps(told), flush=True)
            await asyncio.sleep(REPORT_S)


def _viewer(fields: dict[str, Any]) -> Viewer:
    link = fields.pop("link")
    return Viewer(**fields, link=None if link is None else Link(**link))


async def _main() -> None:
    """Be the viewers that standard input names until it closes."""
    told = json.loads(sys.stdin.readline())
    seats = _Seats(told["url"], told["token"], told["run"])
    tasks = [asyncio.create_task(seats.watch(_viewer(fields))) for fields in told["viewers"]]
    tasks.append(asyncio.create_task(seats.report()))
    await asyncio.to_thread(sys.stdin.read)
    for task in tasks:
        task.cancel()
    for outcome in await asyncio.gather(*tasks, return_exceptions=True):
        if isinstance(outcome, Exception):
            raise outcome


if __name__ == "__main__":
    asyncio.run(_main())
