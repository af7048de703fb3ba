"""The thread that owns the socket: connect, read, write, and come back after a loss.

One daemon thread reads and a second one writes, both blocking; the thread that draws meets them only at the
mailbox and at the outgoing queue, so neither a slow network nor a slow picture holds up the other. The socket
carries what `protocol.ClientSession` says; nothing here interprets a message beyond telling frames from
control.
"""

from __future__ import annotations

import contextlib
import itertools
import queue
import threading
import time
import urllib.parse
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from websockets.exceptions import ConnectionClosed, InvalidHandshake, InvalidStatus, InvalidURI
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Subprotocol

import protocol
from viewer.net.mailbox import Mailbox, MailboxFull
from viewer.net.reconnect import BackOff

__all__ = ["ConnectionState", "ConnectionThread", "NotConnected"]

OPEN_TIMEOUT_S = 10.0
CLOSE_TIMEOUT_S = 2.0
PING_INTERVAL_S = 20.0
OUTGOING_LIMIT = 1024
REFUSED_STATUS = frozenset({400, 401, 403, 404, 426})
REFUSED_CLOSE_CODES = frozenset({1002, 1003, 1008, 4400, 4401, 4403})
LOOPBACK_HOSTS = frozenset({"127.0.0.1", "::1", "localhost"})

Phase = Literal["connecting", "open", "waiting", "refused", "closed"]


class NotConnected(Exception):
    """A message cannot leave: there is no connection now, or too much waits for it."""


@dataclass(frozen=True)
class ConnectionState:
    """What the connection is doing.

    Attributes:
        phase: "connecting", "open", "waiting" (for the next attempt), "refused" (no use to try again) or
            "closed".
        text: one sentence for the user.
        attempt: number of the coming or present attempt since the connection was last open.
        retry_at: `time.monotonic()` value of the next attempt [s]; None unless waiting.
    """

    phase: Phase
    text: str
    attempt: int = 0
    retry_at: float | None = None

    def sentence(self, now: float) -> str:
        """Return the text for the status bar, with an honest countdown while waiting."""
        if self.retry_at is None:
            return self.text
        return f"{self.text}; reconnecting in {max(0.0, self.retry_at - now):.0f} s (attempt {self.attempt})"


class ConnectionThread:
    """A connection to a solver service that keeps itself alive.

    Args:
        url: websocket address, e.g. `ws://127.0.0.1:8765/v1/stream`.
        token: bearer token, None when the service asks for none.
        client: name told to the service.
        back_off: waiting times between attempts.
        woken: called (from a network thread) after something was put into the mailbox.

    Attributes:
        mailbox: what came in: control messages (a `Welcome` opens each new connection) and packed frames.
        state: what the connection is doing now; to be polled.
        resume_point: what the viewer has already; sent in the hello after a loss.
        received_bytes: bytes of all messages that came in.
    """

    def __init__(
        self,
        url: str,
        token: str | None,
        *,
        client: str = "fev-viewer",
        back_off: BackOff | None = None,
        woken: Callable[[], None] | None = None,
    ) -> None:
        self._service = _Service(url, token)
        self.received_bytes = 0
        self.mailbox: Mailbox[protocol.ClientEvent, protocol.Frame] = Mailbox()
        self.resume_point: protocol.ResumePoint | None = None
        self._lost_session: str | None = None
        self._client = client
        self._back_off = back_off if back_off is not None else BackOff()
        self._woken = woken
        self._ids = itertools.count(1)
        self._outgoing: queue.Queue[bytes | None] = queue.Queue(OUTGOING_LIMIT)
        self._lock = threading.Lock()
        self._session: protocol.ClientSession | None = None
        self._socket: ClientConnection | None = None
        self._stop = threading.Event()
        self._nudge = threading.Event()
        self._thread = threading.Thread(target=self._run, name="fev-connection", daemon=True)
        self.state = ConnectionState("connecting", f"connecting to {url}")

    @property
    def url(self) -> str:
        """Websocket address of the service."""
        return self._service.url

    def start(self) -> None:
        """Begin to connect."""
        self._thread.start()

    def retry(self) -> None:
        """Try to connect now rather than after the waiting time; also after a refusal."""
        self._back_off.reset()
        self._nudge.set()

    def change_service(self, url: str, token: str | None) -> None:
        """Leave the service and connect to another one; nothing of the old one comes any more.

        Args:
            url: websocket address of the other one.
            token: its bearer token, None when it asks for none.
        """
        with self._lock:
            self._service = _Service(url, token)
            self._session = None  # what is still to leave was meant for the old one
            self.resume_point = None
            self._lost_session = None
            self.state = ConnectionState("connecting", f"connecting to {url}")
            socket = self._socket
        if socket is not None:
            socket.close()
        self.mailbox.take_control()
        self.mailbox.take_frames()
        self.retry()

    def next_id(self) -> int:
        """Return a command id that was not used on this connection object before."""
        return next(self._ids)

    def send(self, message: protocol.ClientMessage) -> None:
        """Pack a message and queue it for the writer thread.

        Raises:
            NotConnected: the connection is not open, or its outgoing queue is full.
        """
        with self._lock:
            if self._session is None or self._session.state is not protocol.SessionState.OPEN:
                raise NotConnected(f"not connected to {self.url}")
            try:
                packed = self._session.send(message)
            except protocol.Overloaded as error:
                raise NotConnected(str(error)) from None
        try:
            self._outgoing.put_nowait(packed)
        except queue.Full:
            raise NotConnected(f"{OUTGOING_LIMIT} messages wait for {self.url} already") from None

    def close(self) -> None:
        """End the connection and its threads. May be called twice."""
        self._stop.set()
        self._nudge.set()
        socket = self._socket
        if socket is not None:
            socket.close()
        if self._thread.is_alive() and self._thread is not threading.current_thread():
            self._thread.join(CLOSE_TIMEOUT_S + 1.0)

    def _run(self) -> None:
        while not self._stop.is_set():
            try:
                reason = self._connect_and_read()
            except _Refused as refusal:
                self._tell(ConnectionState("refused", str(refusal)))
                self._wait(None)
                continue
            if self._stop.is_set():
                break
            delay = self._back_off.next_delay()
            if not self._nudge.is_set():
                until = time.monotonic() + delay
                self._tell(ConnectionState("waiting", reason, self._back_off.attempt, until))
            self._wait(delay)
        self._tell(ConnectionState("closed", "connection closed"))

    def _wait(self, seconds: float | None) -> None:
        """Wait until the next attempt is due or asked for; None waits for that alone."""
        self._nudge.wait(seconds)
        self._nudge.clear()

    def _connect_and_read(self) -> str:
        """Hold one connection from opening to its end; return why it ended.

        Raises:
            _Refused: the service will not have us, and trying again would not help.
        """
        service = self._service
        self._tell(ConnectionState("connecting", f"connecting to {service.url}", self._back_off.attempt))
        with contextlib.ExitStack() as stack:
            try:
                socket = self._open_socket(stack, service)
            except (OSError, TimeoutError) as error:
                return f"no connection to {service.url}: {_cause(error)}"
            return self._converse(socket, service)

    def _converse(self, socket: ClientConnection, service: _Service) -> str:
        with self._lock:
            self._socket = socket
            if self._service is not service:
                return f"left {service.url}"
        session = protocol.ClientSession(self._client, service.token)
        self._outgoing = queue.Queue(OUTGOING_LIMIT)
        writer = threading.Thread(
            target=self._write, args=(socket, self._outgoing), name="fev-connection-writer", daemon=True
        )
        writer.start()
        try:
            with self._lock:
                self._session = session
                self._outgoing.put(session.open(self._resume()))
            return self._read(socket, session, service)
        finally:
            if session.welcome is not None and self._service is service:
                self._lost_session = session.welcome.session
            with self._lock:
                self._session = None
            self._outgoing.put(None)
            socket.close()
            writer.join(CLOSE_TIMEOUT_S)
            self._socket = None

    def _resume(self) -> protocol.ResumePoint | None:
        """What was last known, and which connection was lost: the control of its runs comes back."""
        point = self.resume_point
        if point is None:
            return None
        return protocol.ResumePoint(point.run, point.last_index, point.revision, self._lost_session)

    def _open_socket(self, stack: contextlib.ExitStack, service: _Service) -> ClientConnection:
        url = service.url
        headers = {} if service.token is None else {"Authorization": f"Bearer {service.token}"}
        try:
            host = urllib.parse.urlsplit(url).hostname or ""
            socket = stack.enter_context(
                connect(
                    url,
                    additional_headers=headers,
                    subprotocols=[Subprotocol(protocol.PROTOCOL_VERSION)],
                    compression=None,
                    max_size=protocol.limits.OUTBOUND_MAX_BYTES,
                    open_timeout=OPEN_TIMEOUT_S,
                    close_timeout=CLOSE_TIMEOUT_S,
                    ping_interval=PING_INTERVAL_S,
                    proxy=None if host in LOOPBACK_HOSTS else True,
                )
            )
        except (InvalidURI, ValueError) as error:
            raise _Refused(
                f"{url!r} is not a websocket address (ws://HOST:PORT/v1/stream): {error}"
            ) from None
        except InvalidStatus as error:
            status = error.response.status_code
            if status in (401, 403):
                raise _Refused(f"{url} refused the token (HTTP {status})") from None
            if status in REFUSED_STATUS:
                raise _Refused(f"{url} is not a solver service that speaks fev.v1 (HTTP {status})") from None
            raise OSError(f"HTTP status {status}") from None
        except InvalidHandshake as error:
            raise _Refused(f"{url} is not a solver service that speaks fev.v1: {error}") from None
        if socket.subprotocol != protocol.PROTOCOL_VERSION:
            raise _Refused(f"{url} does not speak {protocol.PROTOCOL_VERSION}")
        return socket

    def _read(self, socket: ClientConnection, session: protocol.ClientSession, service: _Service) -> str:
        url = service.url
        try:
            for data in socket:
                if self._service is not service:
                    return f"left {url}"
                self.received_bytes += len(data)
                if isinstance(data, str):
                    return f"{url} sent text where fev.v1 has bytes"
                with self._lock:
                    messages = session.receive(data)
                for message in messages:
                    self._deliver(message)
                if messages and self._woken is not None:
                    self._woken()
        except ConnectionClosed:
            pass  # told by the close code below
        except protocol.ProtocolError as error:
            return f"{url} sent something that is not fev.v1: {error}"
        except MailboxFull as error:
            return f"the connection was cut: {error}"
        code, reason = socket.close_code, socket.close_reason
        if code in REFUSED_CLOSE_CODES:
            raise _Refused(f"{url} closed the connection: {reason or f'code {code}'}")
        return f"connection to {url} lost" + (f": {reason}" if reason else "")

    def _deliver(self, message: protocol.ClientEvent) -> None:
        if isinstance(message, protocol.Frame):
            self.mailbox.put_frame(message)
            return
        if isinstance(message, protocol.Welcome):
            self._back_off.reset()
            self._tell(ConnectionState("open", f"connected to {self.url}"))
        self.mailbox.put_control(message)

    def _tell(self, state: ConnectionState) -> None:
        with self._lock:
            self.state = state
        if self._woken is not None:
            self._woken()

    @staticmethod
    def _write(socket: ClientConnection, outgoing: queue.Queue[bytes | None]) -> None:
        while (packed := outgoing.get()) is not None:
            try:
                socket.send(packed)
            except ConnectionClosed:
                return  # the reader tells why


@dataclass(frozen=True, repr=False)
class _Service:
    """Where the service is: its address, and its bearer token or None."""

    url: str
    token: str | None


class _Refused(Exception):
    """The service will not have us; the text says why."""


def _cause(error: BaseException) -> str:
    if isinstance(error, ConnectionRefusedError):
        return "nothing listens there"
    if isinstance(error, TimeoutError):
        return f"no answer within {OPEN_TIMEOUT_S:.0f} s"
    return str(error) or type(error).__name__
