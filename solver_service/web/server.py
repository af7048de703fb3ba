"""Running the service: socket, ready line, signals, and an end within seconds whatever the clients do."""

from __future__ import annotations

import asyncio
import contextlib
import json
import os
import signal
import socket
import sys
import threading
from collections.abc import Callable
from pathlib import Path

import uvicorn

from protocol import limits
from solver_service.errors import ServeError
from solver_service.logging_setup import conceal, set_up_logging
from solver_service.runs import Patience, RoomRules, RunRegistry
from solver_service.store import DataFolder
from solver_service.uploads.upload_desk import UploadDesk
from solver_service.web.app import create_app
from solver_service.web.auth import Gate, load_token
from solver_service.web.disk_watch import watch_disk
from solver_service.web.quotas import Quotas
from solver_service.web.settings import ServiceSettings
from solver_service.web.tls import check_tls
from solver_service.web.token_store import TokenStore
from solver_service.web.token_watch import watch_tokens

BACKLOG = 128
GOING_AWAY = 1001
GRACEFUL_SHUTDOWN_S = 2
PING_INTERVAL_S = 10.0
PING_TIMEOUT_S = 15.0
"""A peer that does not answer a ping for so long is dropped: at most 25 s after it has died."""
UNACKNOWLEDGED_MS = 15_000
"""A peer that takes nothing for so long is dropped by the system; pings do not find it while a send waits."""
UNSENT_BYTES = 65_536
"""What the system may hold back for a peer; more would keep pings and answers from it on a slow link."""


def run_service(settings: ServiceSettings) -> None:
    """Run the service until it is told to stop.

    Raises:
        ServeError: the address is taken, or the token file cannot be used.
        StoreError: the data folder is in use or cannot be used.
        CaseError: an offered case cannot be read.
    """
    set_up_logging(settings.log_format, settings.log_level)
    check_tls(settings)
    listener = _listen(settings.host, settings.port)
    try:
        registry = RunRegistry(
            settings.data_dir,
            cases=settings.cases,
            device=settings.device,
            threads=settings.threads,
            ring_bytes=settings.ring_bytes,
            checkpoint_interval_s=settings.checkpoint_interval_s,
            spare_workers=settings.spare_workers,
            restart_attempts=settings.restart_attempts,
            restart_within_s=settings.restart_within_s,
            log_format=settings.log_format,
            log_level=settings.log_level,
            patience=Patience(settings.worker_silence_s, settings.worker_stall_s),
            channels=settings.channels,
            room=RoomRules(settings.store_bytes, settings.reserve_bytes),
        )
        tokens = TokenStore(settings.data_dir)
        quotas = Quotas(settings.limits, tokens, registry)
        desk = UploadDesk(registry, DataFolder(settings.data_dir), settings.upload_rules)
        quotas.count_disk(desk.owned_bytes)
        secret = load_token(settings.token_path)
        conceal(secret)
        gate = Gate(secret, settings.allowed_origins, tokens)
    except BaseException:
        listener.close()
        raise
    server = _Server(settings, registry, gate, tokens, quotas, desk, lambda: _tell_ready(settings, listener))
    # uvicorn raises the signal that stopped it once more when it is done; it has done its work by then
    signal.signal(signal.SIGTERM, lambda number, frame: None)
    if settings.stop_with_stdin:
        threading.Thread(target=server.stop_with_stdin, name="stdin-watch", daemon=True).start()
    with contextlib.suppress(KeyboardInterrupt):
        asyncio.run(server.serve(sockets=[listener]))


class _Server(uvicorn.Server):
    """A uvicorn server that opens and closes the runs around its own life."""

    def __init__(
        self,
        settings: ServiceSettings,
        registry: RunRegistry,
        gate: Gate,
        tokens: TokenStore,
        quotas: Quotas,
        desk: UploadDesk,
        on_ready: Callable[[], None],
    ) -> None:
        self._registry = registry
        self._gate = gate
        self._tokens = tokens
        self._quotas = quotas
        self._desk = desk
        self._on_ready = on_ready
        self._app = create_app(registry, gate, tokens, quotas, desk, settings.store_bytes)
        super().__init__(
            uvicorn.Config(
                self._app,
                ssl_certfile=settings.tls_certificate,
                ssl_keyfile=settings.tls_key,
                ws="websockets-sansio",
                ws_max_size=limits.INBOUND_MAX_BYTES,
                ws_per_message_deflate=False,
                ws_ping_interval=PING_INTERVAL_S,
                ws_ping_timeout=PING_TIMEOUT_S,
                timeout_graceful_shutdown=GRACEFUL_SHUTDOWN_S,
                lifespan="off",
                log_config=None,
            )
        )

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        await self._registry.open()
        watches = (
            watch_tokens(self._gate, self._app.state.connections),
            watch_disk(self._quotas, self._registry),
            self._app.state.metrics.loop_lag.work(),
        )
        self._watches = [asyncio.get_running_loop().create_task(watch) for watch in watches]
        await super().startup(sockets)
        self._app.state.accepts = True
        self._on_ready()

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        self._app.state.accepts = False
        for watch in self._watches:
            watch.cancel()
        for connection in tuple(self._app.state.connections):
            connection.end(GOING_AWAY, "the service is ending")
        await self._app.state.feed.close()
        await self._desk.close()
        await asyncio.gather(super().shutdown(sockets), self._registry.close())
        self._tokens.close()

    def stop_with_stdin(self) -> None:
        """Wait for the end of standard input, then stop.

        Reads the descriptor, not the buffered file: its lock must not be held when the interpreter ends.
        """
        while os.read(sys.stdin.fileno(), 4096):
            pass
        self.should_exit = True


def _listen(host: str, port: int) -> socket.socket:
    """A listening socket.

    Raises:
        ServeError: the address is taken or not ours.
    """
    listener = None
    try:
        found = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE)
        # with the protocol named asyncio turns Nagle's algorithm off; without, answers come 40 ms late
        listener = socket.socket(found[0][0], socket.SOCK_STREAM, socket.IPPROTO_TCP)
        if os.name == "posix":
            listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listener.bind((host, port))
        listener.listen(BACKLOG)
    except OSError as error:
        if listener is not None:
            listener.close()
        raise ServeError(
            f"cannot listen on {host} port {port}: {error.strerror or error}; "
            "another service may run there, --port 0 takes a free one"
        ) from error
    if hasattr(socket, "TCP_USER_TIMEOUT"):
        listener.setsockopt(socket.IPPROTO_TCP, socket.TCP_USER_TIMEOUT, UNACKNOWLEDGED_MS)
    if hasattr(socket, "TCP_NOTSENT_LOWAT"):
        listener.setsockopt(socket.IPPROTO_TCP, socket.TCP_NOTSENT_LOWAT, UNSENT_BYTES)
    return listener


def _tell_ready(settings: ServiceSettings, listener: socket.socket) -> None:
    host, port = listener.getsockname()[:2]
    host = f"[{host}]" if ":" in host else host
    secure = "" if settings.tls_certificate is None else "s"
    line = json.dumps(
        {
            "event": "listening",
            "url": f"ws{secure}://{host}:{port}/v1/stream",
            "http": f"http{secure}://{host}:{port}",
            "pid": os.getpid(),
            "token_file": str(settings.token_path),
            "data_dir": str(settings.data_dir),
        }
    )
    if settings.ready_file is not None:
        _write_whole(settings.ready_file, line + "\n")
    print(line, flush=True)


def _write_whole(path: Path, text: str) -> None:
    """Write a file that a reader sees complete or not at all.

    Raises:
        ServeError: it cannot be written.
    """
    temporary = path.with_name(f"{path.name}.{os.getpid()}")
    try:
        temporary.write_text(text, encoding="utf-8")
        temporary.replace(path)
    except OSError as error:
        raise ServeError(f"ready file {path} cannot be written: {error.strerror or error}") from error
