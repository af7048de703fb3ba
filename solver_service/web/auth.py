"""The token: random, in a file that only its owner can read, compared without telling how far it matched."""

from __future__ import annotations

import hmac
import os
import secrets
from pathlib import Path

from solver_service.errors import ServeError

TOKEN_BYTES = 32
SHORTEST_TOKEN = 16


def load_token(path: Path) -> str:
    """The token of a file; a random one of 256 bits is written (mode 600) where there is none.

    Raises:
        ServeError: the file cannot be read or written, or holds something that is no token.
    """
    try:
        if not path.exists():
            path.parent.mkdir(parents=True, exist_ok=True)
            descriptor = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
            with os.fdopen(descriptor, "w", encoding="ascii") as file:
                file.write(secrets.token_urlsafe(TOKEN_BYTES) + "\n")
        token = path.read_text(encoding="ascii").strip()
    except (OSError, UnicodeDecodeError) as error:
        raise ServeError(f"token file {path} cannot be used: {error}") from error
    if len(token) < SHORTEST_TOKEN or not token.isprintable() or " " in token:
        raise ServeError(
            f"token file {path} holds no token; one line of {SHORTEST_TOKEN} or more characters is allowed"
        )
    return token


class Gate:
    """Decides who may come in."""

    def __init__(self, token: str, allowed_origins: tuple[str, ...] = ()) -> None:
        """Guard with a token.

        Args:
            token: the secret.
            allowed_origins: origins of web pages that are served beside the own address.
        """
        self._token = token.encode()
        self._allowed_origins = frozenset(allowed_origins)

    def accepts_token(self, token: str | None) -> bool:
        """Whether this is the token."""
        return token is not None and hmac.compare_digest(token.encode(), self._token)

    def accepts_header(self, authorization: str | None) -> bool:
        """Whether an Authorization header carries the token."""
        scheme, _, token = (authorization or "").partition(" ")
        return scheme.lower() == "bearer" and self.accepts_token(token.strip())

    def accepts_origin(self, origin: str | None, host: str | None) -> bool:
        """Whether a page of this origin may connect; programs that are no browsers send none."""
        if origin is None or origin in self._allowed_origins:
            return True
        return host is not None and origin in (f"http://{host}", f"https://{host}")
