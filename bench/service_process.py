"""A real service process and a client on a real socket, for benches and end-to-end tests."""

from __future__ import annotations

import json
import socket
import subprocess
import sys
import time
import urllib.request
from collections.abc import Callable
from pathlib import Path
from types import TracebackType
from typing import IO, Any, TypeVar

from websockets.sync.client import ClientConnection, connect

import protocol

TIMEOUT_S = 60.0

_SERVE = """
import json, sys
from pathlib import Path
from solver_service.web import ServiceSettings, serve
if __name__ == "__main__":
    options = json.loads(sys.argv[2])
    options["cases"] = tuple(options.get("cases", ()))
    serve(ServiceSettings(data_dir=Path(sys.argv[1]), stop_with_stdin=True, **options))
"""

E = TypeVar("E")


class ServiceProcess:
    """A service on a free port; ends with its `with` block.

    Args:
        data_dir: the data folder.
        stderr: file for its log lines; those of this process where there is none.
        options: further fields of `ServiceSettings`.
    """

    def __init__(self, data_dir: Path, stderr: IO[bytes] | None = None, **options: Any) -> None:
        self.data_dir = data_dir
        self._stderr = stderr
        self._options = options
        self.url = ""
        self.http = ""
        self.token = ""
        self.process: subprocess.Popen[str]

    def __enter__(self) -> ServiceProcess:
        """Start it and wait for its ready line."""
        command = [sys.executable, "-c", _SERVE, str(self.data_dir), json.dumps(self._options)]
        self.process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self._stderr, text=True
        )
        assert self.process.stdout is not None
        line = self.process.stdout.readline()
        if not line:
            self._close()
            raise RuntimeError(f"the service ended with status {self.process.returncode} before it listened")
        ready = json.loads(line)
        self.url, self.http = ready["url"], ready["http"]
        self.token = Path(ready["token_file"]).read_text(encoding="ascii").strip()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Ask it to end; kill it where it does not."""
        self._close()

    def stop(self, timeout_s: float = 15.0) -> float:
        """Close its standard input and wait.

        Returns:
            How long it took to end [s].
        """
        assert self.process.stdin is not None
        begun = time.perf_counter()
        self.process.stdin.close()
        self.process.wait(timeout_s)
        return time.perf_counter() - begun

    def get(self, path: str) -> Any:
        """What a REST path answers, from JSON."""
        return json.loads(self._read(path))

    def metrics(self) -> dict[str, float]:
        """The samples of `/metrics` by name and labels."""
        lines = self._read("/metrics").splitlines()
        samples = (line.rpartition(" ") for line in lines if line and not line.startswith("#"))
        return {name: float(value) for name, _, value in samples}

    def status(self) -> dict[str, Any]:
        """What the service tells of itself."""
        return dict(self.get("/v1/status"))

    def _read(self, path: str) -> str:
        request = urllib.request.Request(
            f"{self.http}{path}", headers={"Authorization": f"Bearer {self.token}"}
        )
        with urllib.request.urlopen(request, timeout=TIMEOUT_S) as answer:
            return str(answer.read(), "utf-8")

    def _close(self) -> None:
        try:
            self.stop()
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        finally:
            if self.process.stdout is not None:
                self.process.stdout.close()


class ServiceClient:
    """A viewer without pictures: the wire's own client session over a blocking websocket.

    Args:
        service: where to connect.
        resume: what was last known, for a connection that replaces a lost one.
        grants_credit: whether each frame received is paid with a new credit at once.
        layout: blocks of the grid, to decode every frame as it comes.

    Attributes:
        decoded: the frames received so far by run and index, where a layout was given.
    """

    def __init__(
        self,
        service: ServiceProcess,
        resume: protocol.ResumePoint | None = None,
        grants_credit: bool = True,
        layout: protocol.BlockLayout | None = None,
    ) -> None:
        self.session = protocol.ClientSession("fev-bench")
        self.grants_credit = grants_credit
        self.decoded: dict[tuple[str, int], protocol.DecodedFrame] = {}
        self._decoder = protocol.FrameDecoder(layout) if layout is not None else None
        self._service = service
        self._resume = resume
        self._connection: ClientConnection

    def __enter__(self) -> ServiceClient:
        """Connect and say hello."""
        self._connection = connect(
            self._service.url,
            subprotocols=[protocol.PROTOCOL_VERSION],  # type: ignore[list-item]
            additional_headers={"Authorization": f"Bearer {self._service.token}"},
            compression=None,
            max_size=protocol.limits.OUTBOUND_MAX_BYTES,
            close_timeout=1.0,
        ).__enter__()
        self._connection.send(self.session.open(self._resume))
        self.until(lambda event: isinstance(event, protocol.Welcome))
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Close the connection."""
        self._connection.close()

    def cut(self) -> None:
        """Lose the connection, as a network does."""
        self._connection.socket.shutdown(socket.SHUT_RDWR)

    def until(self, wanted: Callable[[protocol.ClientEvent], bool], timeout_s: float = TIMEOUT_S) -> Any:
        """Receive until an event is wanted; give that one.

        Raises:
            TimeoutError: it did not come.
        """
        ends = time.monotonic() + timeout_s
        while True:
            data = self._connection.recv(timeout=max(ends - time.monotonic(), 0.0))
            assert isinstance(data, bytes)
            for event in self.session.receive(data):
                if isinstance(event, protocol.Frame):
                    if self._decoder is not None:
                        self.decoded[event.run, event.index] = self._decoder.decode(event)
                    if self.grants_credit:
                        self.send(protocol.Credit(1))
                if wanted(event):
                    return event

    def first(self, kind: type[E], test: Callable[[E], bool] = lambda event: True, **options: float) -> E:
        """Receive until an event of a kind passes a test."""
        found: E = self.until(lambda event: isinstance(event, kind) and test(event), **options)
        return found

    def send(self, message: protocol.ClientMessage) -> None:
        """Send one message."""
        self._connection.send(self.session.send(message))

    def ask(self, kind: type[protocol.Command], **fields: Any) -> Any:
        """Send a command and wait for its answer: an `Ack`, `Error`, `CaseList` or `RunList`."""
        command = kind(id=self.session.next_id(), **fields)
        self.send(command)
        answers = (protocol.Ack, protocol.Error, protocol.CaseList, protocol.RunList)
        return self.until(lambda event: isinstance(event, answers) and event.id == command.id)

    def do(self, kind: type[protocol.Command], **fields: Any) -> dict[str, Any]:
        """Send a command that must be obeyed.

        Returns:
            The result of its `ack`.

        Raises:
            RuntimeError: it was refused.
        """
        answer = self.ask(kind, **fields)
        if not isinstance(answer, protocol.Ack):
            raise RuntimeError(f"{protocol.operation(kind)} was refused: {answer}")
        return dict(answer.result)

    def frame(self, run: str, index: int) -> protocol.Frame:
        """Receive until a frame comes."""
        return self.first(protocol.Frame, lambda frame: (frame.run, frame.index) == (run, index))
