"""A solver service of one's own: started beside the viewer, ended with it.

The service is another program (`python -m solver_service serve`); this module never imports it. It gets a
random
token through a file that only this user can read, says in one JSON line where it listens, and ends when its
standard input closes, so that even a killed viewer leaves no service behind.
"""

from __future__ import annotations

import collections
import contextlib
import json
import os
import queue
import secrets
import subprocess
import sys
import tempfile
import threading
from collections.abc import Sequence
from pathlib import Path
from types import TracebackType

from viewer.errors import ViewerError

__all__ = ["LocalService", "LocalServiceError"]

READY_TIMEOUT_S = 120.0
STOP_TIMEOUT_S = 8.0
KEPT_ERROR_LINES = 40


class LocalServiceError(ViewerError):
    """The service did not start; the text holds what it said."""


class LocalService:
    """A running `fev-solver serve` on a free port of this machine.

    Args:
        data_dir: where the service keeps its store; None: the service's own default.
        extra_arguments: further arguments of `fev-solver serve`.
        ready_timeout_s: wall time within which it must listen [s].

    Attributes:
        url: websocket address to connect to.
        token: what to authorise with.
        pid: process id of the service.

    Raises:
        LocalServiceError: the service ended, or stayed silent, before it listened.
    """

    def __init__(
        self,
        data_dir: Path | None = None,
        extra_arguments: Sequence[str] = (),
        ready_timeout_s: float = READY_TIMEOUT_S,
    ) -> None:
        self.token = secrets.token_urlsafe(32)
        self._folder = tempfile.TemporaryDirectory(prefix="fev-")
        token_file = Path(self._folder.name) / "token"
        descriptor = os.open(token_file, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
        with os.fdopen(descriptor, "w", encoding="utf-8") as stream:
            stream.write(self.token + "\n")
        command = [sys.executable, "-m", "solver_service", "serve", "--host", "127.0.0.1", "--port", "0"]
        command += ["--token-file", str(token_file), "--stop-with-stdin"]
        if data_dir is not None:
            command += ["--data-dir", str(data_dir)]
        command += list(extra_arguments)
        self._process = subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            encoding="utf-8",
            errors="replace",
        )
        self.pid = self._process.pid
        self._error_lines: collections.deque[str] = collections.deque(maxlen=KEPT_ERROR_LINES)
        self._ready: queue.Queue[str | None] = queue.Queue()
        self._readers = [
            threading.Thread(target=self._read_output, name="service-stdout", daemon=True),
            threading.Thread(target=self._read_errors, name="service-stderr", daemon=True),
        ]
        for reader in self._readers:
            reader.start()
        try:
            self.url = self._wait_until_listening(ready_timeout_s)
        except BaseException:
            self.close()
            raise

    def __enter__(self) -> LocalService:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, value: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self.close()

    @property
    def is_running(self) -> bool:
        """Whether the service process still lives."""
        return self._process.poll() is None

    @property
    def last_words(self) -> str:
        """The last line the service wrote to standard error, or an empty text."""
        lines = [line for line in self._error_lines if line.strip()]
        return lines[-1].strip() if lines else ""

    def close(self) -> None:
        """End the service (close its input, terminate, kill); remove the token. May be called twice."""
        process = self._process
        if process.stdin is not None and not process.stdin.closed:
            with contextlib.suppress(OSError):  # it has ended already, which is what closing asks for
                process.stdin.close()
        for demand in (None, process.terminate, process.kill):
            if demand is not None and process.poll() is None:
                demand()
            try:
                process.wait(STOP_TIMEOUT_S)
                break
            except subprocess.TimeoutExpired:
                continue
        for reader in self._readers:
            reader.join(1.0)
        for stream in (process.stdout, process.stderr):
            if stream is not None:
                stream.close()
        self._folder.cleanup()

    def _wait_until_listening(self, timeout_s: float) -> str:
        try:
            line = self._ready.get(timeout=timeout_s)
        except queue.Empty:
            raise LocalServiceError(
                f"the solver service did not listen within {timeout_s:.0f} s; its last words: "
                f"{self.last_words or 'none'}"
            ) from None
        if line is None:
            code = self._process.wait(STOP_TIMEOUT_S)
            self._readers[1].join(1.0)
            raise LocalServiceError(
                f"the solver service ended with exit status {code}: {self.last_words or 'it said nothing'}"
            )
        return line

    def _read_output(self) -> None:
        assert self._process.stdout is not None
        for line in self._process.stdout:
            url = _listening_url(line)
            if url is not None:
                self._ready.put(url)
        self._ready.put(None)

    def _read_errors(self) -> None:
        assert self._process.stderr is not None
        for line in self._process.stderr:
            self._error_lines.append(line.rstrip("\n"))


def _listening_url(line: str) -> str | None:
    """Return the websocket address in the service's ready line, None for any other line."""
    try:
        event = json.loads(line)
    except ValueError:
        return None
    if isinstance(event, dict) and event.get("event") == "listening" and isinstance(event.get("url"), str):
        url: str = event["url"]
        return url
    return None
