"""Where a service is: its address and the token for it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from viewer.errors import ViewerError

__all__ = ["Endpoint", "read_token", "stream_url"]

STREAM_PATH = "/v1/stream"
SCHEMES = ("ws://", "wss://")


@dataclass(frozen=True)
class Endpoint:
    """Where the service is.

    Attributes:
        url: websocket address; None starts a service on this machine.
        token: bearer token of the service at `url`.
        data_dir: where a service on this machine keeps its store; None: its own default.
    """

    url: str | None = None
    token: str | None = None
    data_dir: Path | None = None


def stream_url(url: str) -> str:
    """Return the websocket address of the stream, with its path when `url` has none.

    Raises:
        ViewerError: it is no websocket address.
    """
    if not url.startswith(SCHEMES):
        raise ViewerError(f"the address {url!r} is not allowed; it must begin with ws:// or wss://")
    rest = url.partition("://")[2]
    return url if "/" in rest.rstrip("/") else url.rstrip("/") + STREAM_PATH


def read_token(path: Path | None) -> str | None:
    """Return the token in a file, None without one.

    Raises:
        ViewerError: the file cannot be read, or is empty.
    """
    if path is None:
        return None
    try:
        token = path.read_text(encoding="utf-8").strip()
    except (OSError, UnicodeDecodeError) as error:
        raise ViewerError(f"the token file {path} cannot be read: {error}") from None
    if not token:
        raise ViewerError(f"the token file {path} is empty")
    return token
