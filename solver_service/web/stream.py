"""One websocket connection: a reader, a worker through its commands, and a sender, in one task group."""

from __future__ import annotations

import asyncio
import logging
import secrets
import time
from collections.abc import Awaitable, Set
from typing import Any

from starlette.websockets import WebSocket, WebSocketDisconnect

from protocol import (
    Command,
    ControlChanged,
    ControlRequested,
    EditsChanged,
    Error,
    ForcingChanged,
    Hello,
    Notice,
    Progress,
    ProtocolError,
    RunBranched,
    RunChanged,
    RunRemoved,
    ServerMessage,
    ServerSession,
    SessionState,
    ViewPresented,
    WaterBudget,
    Welcome,
    operation,
)
from solver_service.errors import AccessError, ServiceError, StoreError
from solver_service.logging_setup import log_context, tag_log
from solver_service.runs import RunRegistry, Session
from solver_service.web.auth import Access, Gate
from solver_service.web.commands import carry_out
from solver_service.web.error_codes import wire_code
from solver_service.web.frame_feed import FrameFeed
from solver_service.web.outbox import Outbox
from solver_service.web.quotas import Quotas
from solver_service.web.scopes import COMMAND_SCOPES, Scope, check_scope
from solver_service.web.version import SERVER_NAME, server_version

LOG = logging.getLogger(__name__)

HELLO_TIMEOUT_S = 5.0
SEND_TIMEOUT_S = 20.0
POLICY_VIOLATION = 1008
INTERNAL_ERROR = 1011
TRY_LATER = 1013
REPLACED = 4001
AFTER_ANSWER = RunChanged | RunBranched | EditsChanged | ForcingChanged
"""News that wait until the command under way is answered."""


class ConnectionEnded(Exception):
    """The connection is over; ends the task group."""


class StreamConnection:
    """A client on the stream; a `Listener` of the runs.

    Attributes:
        is_welcome: whether it was let in and has not ended.
    """

    def __init__(
        self,
        websocket: WebSocket,
        registry: RunRegistry,
        gate: Gate,
        quotas: Quotas,
        access: Access | None,
        others: Set[StreamConnection] = frozenset(),
    ) -> None:
        """A connection that has been accepted.

        Args:
            websocket: the socket.
            registry: the runs.
            gate: who may come in.
            quotas: how much whoever comes in may take.
            access: what the token of the Authorization header allows; None where the hello must bring one.
            others: the connections there are, itself included.
        """
        self.session = ServerSession()
        self.registry = registry
        self.quotas = quotas
        self.feed = FrameFeed(registry, self.session)
        self.outbox = Outbox()
        self.name = f"s{secrets.token_hex(6)}"
        self._others = others
        self._websocket = websocket
        self._gate = gate
        self.access = access
        self._since = time.time()
        self._bytes_sent = 0
        self._commands: asyncio.Queue[Command] = asyncio.Queue()
        self._busy_with: Command | None = None
        self._held: list[ServerMessage] = []
        self._controlled: set[str] = set()
        self.is_welcome = False

    async def serve(self) -> None:
        """Talk until either side ends it."""
        tag_log(session=self.name, token=(self.access and self.access.token) or "")
        try:
            async with asyncio.TaskGroup() as tasks:
                tasks.create_task(self._send())
                tasks.create_task(self._read())
                tasks.create_task(self._work())
        except* (ConnectionEnded, WebSocketDisconnect):
            LOG.info("the session ended")
        finally:
            self.is_welcome = False
            self.registry.audience.remove(self)
            self.registry.controllers.ended(self.name)
            self.registry.presentations.ended(self.name)
            self.session.close()

    def end(self, code: int, reason: str) -> None:
        """Close the connection from our side."""
        self.outbox.close(code, reason)

    def withdraw(self) -> None:
        """Tell the client that its token no longer holds, and close."""
        if self.outbox.closing is None and self.session.state is not SessionState.CLOSED:
            self._refuse(POLICY_VIOLATION, "wrong_token", "The token was revoked or has expired.")

    def facts(self) -> dict[str, Any]:
        """What an operator wants to know of the connection; `since` in seconds since 1970."""
        client = self._websocket.client
        return {
            "session": self.name,
            "client": self.identity.client,
            "address": "" if client is None else f"{client.host}:{client.port}",
            "token": None if self.access is None else self.access.label,
            "scope": None if self.access is None else str(self.access.scope),
            "run": self.feed.run,
            "since": self._since,
            "bytes_sent": self._bytes_sent,
            "credit": self.session.credit,
        }

    @property
    def identity(self) -> Session:
        """Who it is, as the others see it."""
        return Session(self.name, self.session.hello.client if self.session.hello is not None else "")

    def find_session(self, name: str) -> Session | None:
        """A connection by its id."""
        return next((other.identity for other in self._others if other.name == name), None)

    # what the runs say

    def announce(self, message: ServerMessage) -> None:
        """Queue what concerns this client; news of runs wait until the command under way is answered."""
        match message:
            case Progress() | WaterBudget() if message.run != self.feed.run:
                return
            case ControlChanged():
                if self._concerns(message):
                    self.tell(message)
                return
            case ViewPresented() if message.session == self.name:
                return
            case ControlRequested() if message.run not in self._controlled:
                return
            case RunRemoved():
                self.feed.leave(message.run)
            case EditsChanged() | ForcingChanged() if message.run not in self._heeded:
                return
            case _ if self._busy_with is not None and isinstance(message, AFTER_ANSWER):
                self._held.append(message)
                return
            case _:
                pass
        self.tell(message)

    @property
    def _heeded(self) -> tuple[str | None, ...]:
        """Runs whose working lists the client wants to know: the watched one and that of its command."""
        return self.feed.run, getattr(self._busy_with, "run", None)

    def _concerns(self, message: ControlChanged) -> bool:
        """Whether a change of control is of a watched run, or of one that is or was controlled from here."""
        held = message.run in self._controlled
        if message.session == self.name:
            self._controlled.add(message.run)
        else:
            self._controlled.discard(message.run)
        return held or message.session == self.name or message.run == self.feed.run

    def frame_stored(self, run: str) -> None:
        """Let the sender look for the new frame."""
        if run == self.feed.run:
            self.outbox.wake()

    def tell(self, message: ServerMessage) -> None:
        """Queue one message; a connection that is over hears nothing."""
        if self.session.state is not SessionState.CLOSED:
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
        try:
            self.access = self.access or self._gate.access(hello.token)
        except StoreError as error:
            self._refuse(INTERNAL_ERROR, wire_code(error), str(error))
            return
        if self.access is None:
            self._refuse(POLICY_VIOLATION, "wrong_token", "The token is missing or wrong.")
            return
        try:
            self.quotas.view(self.access, self._count_same_owner(hello))
        except AccessError as error:
            self._refuse(TRY_LATER, wire_code(error), str(error))
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
            with log_context(run=getattr(command, "run", "")):
                await self._obey(command)

    async def _obey(self, command: Command) -> None:
        level = logging.DEBUG if COMMAND_SCOPES[type(command)] is Scope.VIEWER else logging.INFO
        LOG.log(level, "%s", operation(command))
        self._busy_with = command
        try:
            if self.access is None or not self._gate.still_holds(self.access):
                self.withdraw()
                return
            check_scope(command, self.access.scope)
            # what has begun is carried to its end although the connection may end meanwhile
            await self.registry.carry_through(carry_out(command, self, self.access))
        except (ServiceError, ProtocolError) as error:
            LOG.info("%s is refused: %s", operation(command), error)
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
                await put_through(self._websocket.send_bytes(packet))
                self._bytes_sent += len(packet)
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
        return message

    async def _until_closed(self) -> None:
        """Hear nothing more; the sender closes the connection, which ends all tasks."""
        await asyncio.Event().wait()

    def _count_same_owner(self, hello: Hello) -> int:
        """How many streams of the same owner stay open beside this one."""
        replaced = hello.resume.session if hello.resume is not None else None
        return sum(
            other.access == self.access and other.name != replaced and other.is_welcome
            for other in self._others
            if other is not self
        )

    def _welcome(self, hello: Hello) -> None:
        self.is_welcome = True
        self.tell(
            Welcome(
                protocol=self.session.version or "",
                server=SERVER_NAME,
                version=server_version(),
                session=self.name,
                devices=self.registry.pool.devices,
            )
        )
        tag_log(token=(self.access and self.access.token) or "")
        LOG.info("welcome %s", hello.client or "unnamed client")
        self.registry.audience.add(self)
        for presented in self.registry.presentations.current:
            self.tell(presented)
        if hello.resume is not None and hello.resume.run in self.registry.tree:
            run = self.registry.tree.get(hello.resume.run)
            self.tell(RunChanged(self.registry.tree.info(run)))
            self.tell(self.registry.edits.changed(run.run))
            self.tell(self.registry.forcing.changed(run.run))
            for places in self.registry.tree.places(run.run):
                self.tell(places)
        if hello.resume is not None and hello.resume.session is not None:
            self._replace(hello.resume.session)

    def _replace(self, lost: str) -> None:
        """Take the place of a connection that may not know yet that it is lost."""
        for other in self._others:
            if other.name == lost and other is not self and other.access == self.access:
                self.registry.controllers.replaced(lost, self.identity)
                other.end(REPLACED, f"session {self.name} has taken the place of this one")

    def _refuse(self, close_code: int, code: str, sentence: str) -> None:
        self.outbox.put(self.session.send(Error(None, code, sentence)))
        self.outbox.close(close_code, sentence)

    async def _close(self, code: int, reason: str) -> None:
        await put_through(self._websocket.close(code, reason[:120]))
        raise ConnectionEnded


async def put_through(sending: Awaitable[None]) -> None:
    """Send something over a websocket.

    Raises:
        ConnectionEnded: the client takes nothing for `SEND_TIMEOUT_S`, or has answered no ping.
    """
    try:
        async with asyncio.timeout(SEND_TIMEOUT_S):
            await sending
    except TimeoutError as error:
        raise ConnectionEnded from error
    except RuntimeError as error:  # what the server below says once it has closed on a silent client
        raise ConnectionEnded from error
