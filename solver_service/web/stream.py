"""One websocket connection: a reader, a worker through its commands, and a sender, in one task group."""

from __future__ import annotations

import asyncio
import logging
import secrets

from starlette.websockets import WebSocket, WebSocketDisconnect

from protocol import (
    Command,
    EditsChanged,
    Error,
    Hello,
    Notice,
    Progress,
    ProtocolError,
    RunBranched,
    RunChanged,
    Seek,
    ServerMessage,
    ServerSession,
    Subscribe,
    Unsubscribe,
    Welcome,
)
from solver_service.errors import ServiceError, StoreError
from solver_service.runs import RunRegistry
from solver_service.web.auth import Gate
from solver_service.web.commands import carry_out
from solver_service.web.error_codes import wire_code
from solver_service.web.frame_feed import FrameFeed
from solver_service.web.outbox import Outbox
from solver_service.web.version import SERVER_NAME, server_version

LOG = logging.getLogger(__name__)

HELLO_TIMEOUT_S = 5.0
SEND_TIMEOUT_S = 20.0
POLICY_VIOLATION = 1008


class ConnectionEnded(Exception):
    """The connection is over; ends the task group."""


class StreamConnection:
    """A client on the stream; a `Listener` of the runs."""

    def __init__(self, websocket: WebSocket, registry: RunRegistry, gate: Gate, authorised: bool) -> None:
        """A connection that has been accepted.

        Args:
            websocket: the socket.
            registry: the runs.
            gate: who may come in.
            authorised: whether the Authorization header carried the token.
        """
        self.session = ServerSession()
        self.registry = registry
        self.feed = FrameFeed(registry, self.session)
        self.outbox = Outbox()
        self.name = f"s{secrets.token_hex(6)}"
        self._websocket = websocket
        self._gate = gate
        self._authorised = authorised
        self._commands: asyncio.Queue[Command] = asyncio.Queue()
        self._busy_with: Command | None = None
        self._held: list[ServerMessage] = []

    async def serve(self) -> None:
        """Talk until either side ends it."""
        try:
            async with asyncio.TaskGroup() as tasks:
                tasks.create_task(self._send())
                tasks.create_task(self._read())
                tasks.create_task(self._work())
        except* (ConnectionEnded, WebSocketDisconnect):
            LOG.info("session %s ended", self.name)
        finally:
            self.registry.audience.remove(self)
            self.session.close()

    def end(self, code: int, reason: str) -> None:
        """Close the connection from our side."""
        self.outbox.close(code, reason)

    # what the runs say

    def announce(self, message: ServerMessage) -> None:
        """Queue what concerns this client; news of runs wait until the command under way is answered."""
        match message:
            case Progress() if message.run != self.feed.run:
                return
            case EditsChanged() if message.run not in (self.feed.run, getattr(self._busy_with, "run", None)):
                return
            case RunChanged() | RunBranched() | EditsChanged() if self._busy_with is not None:
                self._held.append(message)
            case _:
                self.tell(message)

    def frame_stored(self, run: str) -> None:
        """Let the sender look for the new frame."""
        if run == self.feed.run:
            self.outbox.wake()

    def tell(self, message: ServerMessage) -> None:
        """Queue one message."""
        self.outbox.put(self.session.send(message))

    # the three tasks

    async def _read(self) -> None:
        try:
            async with asyncio.timeout(HELLO_TIMEOUT_S):
                hello = await self._receive()
        except TimeoutError:
            self._refuse(POLICY_VIOLATION, "no_hello", f"No hello came within {HELLO_TIMEOUT_S:g} s.")
            return
        if not isinstance(hello, Hello):
            return
        if not (self._authorised or self._gate.accepts_token(hello.token)):
            self._refuse(POLICY_VIOLATION, "wrong_token", "The token is missing or wrong.")
            return
        self._welcome(hello)
        while True:
            message = await self._receive()
            if isinstance(message, Command):
                self._commands.put_nowait(message)
            elif message is not None:
                self.outbox.wake()  # credit

    async def _work(self) -> None:
        while True:
            command = await self._commands.get()
            self._busy_with = command
            try:
                await carry_out(command, self)
            except (ServiceError, ProtocolError) as error:
                self.tell(Error(command.id, wire_code(error), str(error)[:2000]))
            finally:
                self._busy_with = None
                held, self._held = self._held, []
            for message in held:
                if not (isinstance(message, RunBranched) and message.child.run == self.feed.run):
                    self.tell(message)

    async def _send(self) -> None:
        while True:
            packet = self.outbox.next()
            if packet is None and self.outbox.closing is not None:
                await self._close(*self.outbox.closing)
            if packet is not None:
                async with asyncio.timeout(SEND_TIMEOUT_S):
                    await self._websocket.send_bytes(packet)
                continue
            try:
                frame = await self.feed.next()
            except StoreError as error:
                self.tell(Notice("error", str(error), self.feed.run))
                continue
            if frame is not None:
                self.outbox.put_bulk(self.session.send_frame(frame))
            else:
                await self.outbox.wait()

    async def _receive(self) -> object:
        """One message, or None when it was refused."""
        event = await self._websocket.receive()
        if event["type"] == "websocket.disconnect":
            raise ConnectionEnded
        data: bytes | None = event.get("bytes")
        if data is None:
            self._refuse(1003, "malformed", "A text message came; only binary messages are allowed.")
            await self._until_closed()
            return None
        try:
            (message,) = self.session.receive(data)
        except ProtocolError as error:
            self.outbox.put(self.session.refuse(error))
            if error.fatal:
                self.outbox.close(error.close_code, str(error))
                await self._until_closed()
            return None
        if isinstance(message, Subscribe | Seek | Unsubscribe):
            LOG.debug("session %s: %r", self.name, message)
        return message

    async def _until_closed(self) -> None:
        """Hear nothing more; the sender closes the connection, which ends all tasks."""
        await asyncio.Event().wait()

    def _welcome(self, hello: Hello) -> None:
        self.tell(
            Welcome(
                protocol=self.session.version or "",
                server=SERVER_NAME,
                version=server_version(),
                session=self.name,
                devices=self.registry.pool.devices,
            )
        )
        LOG.info("session %s: %s", self.name, hello.client or "unnamed client")
        self.registry.audience.add(self)
        if hello.resume is not None and hello.resume.run in self.registry.tree:
            run = self.registry.tree.get(hello.resume.run)
            self.tell(RunChanged(self.registry.tree.info(run)))
            self.tell(self.registry.edits_changed(run.run))

    def _refuse(self, close_code: int, code: str, sentence: str) -> None:
        self.outbox.put(self.session.send(Error(None, code, sentence)))
        self.outbox.close(close_code, sentence)

    async def _close(self, code: int, reason: str) -> None:
        async with asyncio.timeout(SEND_TIMEOUT_S):
            await self._websocket.close(code, reason[:120])
        raise ConnectionEnded
