"""`fev-solver upload`: packs the folder of a case, sends it to a service, and tells how its import goes."""

from __future__ import annotations

import http.client
import json
import sys
import tempfile
import time
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO, Any
from urllib.parse import urlsplit

from solver_service.errors import AccessError, CaseError, ServeError
from solver_service.scenario.case_folder import ARCHIVE_SUFFIX, CASE_FILE
from solver_service.uploads.file_kinds import SUFFIXES, is_allowed

CHUNK_BYTES = 256 << 10
POLL_S = 0.3
TIMEOUT_S = 60.0
SCHEMES = {"ws": False, "http": False, "wss": True, "https": True}


def upload_case(case: Path, server: str, token_file: Path, json_line: bool) -> None:
    """Send a case and wait until it is on offer.

    Args:
        case: a folder with a case.toml, or a .fevcase archive.
        server: address of the service, as the viewer takes it.
        token_file: file with a token of the scope controller.
        json_line: end with one JSON object instead of a sentence.

    Raises:
        CaseError: there is no case, or the service refuses it.
        AccessError: the token file cannot be read, or the token does not allow this.
        ServeError: the service cannot be reached.
    """
    service = _Service(server, _token(token_file))
    with _archive(case) as file:
        record = service.send(file)
    while record["ended"] is None:
        _tell(f"{record['status']} {record['stage']}".strip())
        time.sleep(POLL_S)
        record = service.ask("GET", f"/v1/uploads/{record['upload']}")
    _tell("")
    if record["status"] != "accepted":
        raise CaseError(str(record["message"]))
    for warning in record["warnings"]:
        print(f"warning: {warning}", file=sys.stderr)
    if json_line:
        print(json.dumps({"case": record["case"], "warnings": record["warnings"]}), flush=True)
    else:
        print(f"case {record['case']} is on offer at {server}")


def case_files(folder: Path) -> Iterator[tuple[Path, str]]:
    """The files of a case that are sent, with their names in the archive; tells what is left out.

    Raises:
        CaseError: there is no case file.
    """
    if not (folder / CASE_FILE).is_file():
        raise CaseError(
            f"{folder}: holds no {CASE_FILE}; the folder of a case or a {ARCHIVE_SUFFIX} is allowed."
        )
    left = []
    for path in sorted(folder.rglob("*")):
        name = path.relative_to(folder).as_posix()
        if not path.is_file() or any(part.startswith(".") for part in Path(name).parts):
            continue
        if is_allowed(name):
            yield path, name
        else:
            left.append(name)
    if left:
        few = ", ".join(left[:10]) + (f" and {len(left) - 10} others" if len(left) > 10 else "")
        print(f"left out: {few}; sent are {', '.join(SUFFIXES)}", file=sys.stderr)


@contextmanager
def _archive(case: Path) -> Iterator[IO[bytes]]:
    """The archive to send."""
    if case.is_file() and case.suffix.lower() == ARCHIVE_SUFFIX:
        with case.open("rb") as packed:
            yield packed
        return
    if case.name == CASE_FILE and case.is_file():
        case = case.parent
    with tempfile.TemporaryFile(suffix=ARCHIVE_SUFFIX) as file:
        try:
            with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED, allowZip64=False) as archive:
                for path, name in case_files(case):
                    archive.write(path, name)
        except (OSError, zipfile.LargeZipFile) as error:
            raise CaseError(f"{case}: cannot be packed: {error}.") from error
        yield file


def _token(path: Path) -> str:
    try:
        return path.read_text(encoding="ascii").strip()
    except (OSError, UnicodeDecodeError) as error:
        raise AccessError(f"token file {path} cannot be read: {error}") from error


def _tell(text: str) -> None:
    """A line that the next one replaces, on a terminal only."""
    if sys.stderr.isatty():
        print(f"\r\033[K{text}", end="", file=sys.stderr, flush=True)


class _Service:
    """The REST of a service."""

    def __init__(self, server: str, token: str) -> None:
        address = urlsplit(server if "//" in server else f"http://{server}")
        try:
            self._host, self._port = address.hostname or "", address.port
        except ValueError:  # the port is no number
            self._host = ""
        if address.scheme not in SCHEMES or not self._host:
            raise ServeError(
                f"the server is {server!r}; ws://HOST:PORT or http://HOST:PORT (wss, https) is allowed"
            )
        self._server = server
        self._is_secure = SCHEMES[address.scheme]
        self._headers = {"Authorization": f"Bearer {token}"}

    def send(self, file: IO[bytes]) -> dict[str, Any]:
        """Send an archive; gives the upload."""
        size = file.seek(0, 2)
        file.seek(0)

        def parts() -> Iterator[bytes]:
            sent = 0
            while chunk := file.read(CHUNK_BYTES):
                yield chunk
                sent += len(chunk)
                _tell(f"sent {100 * sent / size:.0f} % of {size / 1e6:.1f} MB")

        headers = {"Content-Type": "application/zip", "Content-Length": str(size)}
        return self.ask("POST", "/v1/uploads", parts(), headers)

    def ask(
        self,
        method: str,
        path: str,
        body: Iterator[bytes] | None = None,
        headers: dict[str, str] | None = None,
    ) -> dict[str, Any]:
        """One request and its answer.

        Raises:
            CaseError: the case is refused.
            AccessError: the token does not allow it.
            ServeError: the service cannot be reached, or says what is no answer.
        """
        kind = http.client.HTTPSConnection if self._is_secure else http.client.HTTPConnection
        connection = kind(self._host, self._port, timeout=TIMEOUT_S)
        try:
            # a service that refuses may answer before it has read everything
            with suppress(BrokenPipeError, ConnectionResetError):
                connection.request(method, path, body, {**self._headers, **(headers or {})})
            answer = connection.getresponse()
            found = json.loads(answer.read() or b"{}")
        except (OSError, http.client.HTTPException, ValueError) as error:
            raise ServeError(f"the service {self._server} gives no answer: {error!r}") from error
        finally:
            connection.close()
        if answer.status < 300 and isinstance(found, dict):
            return found
        detail = str(found.get("detail", answer.reason)) if isinstance(found, dict) else answer.reason
        if answer.status in (401, 403):
            raise AccessError(f"the service {self._server} refuses: {detail}")
        raise CaseError(f"the service {self._server} refuses: {detail}")
