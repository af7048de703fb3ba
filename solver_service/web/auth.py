"""Who may come in: by the token of a file that only its owner can read, or by a token of the token store."""

from __future__ import annotations

import hmac
import os
import secrets
from dataclasses import dataclass
from pathlib import Path

from solver_service.errors import ServeError
from solver_service.web.scopes import Scope
from solver_service.web.token_store import TokenStore

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


@dataclass(frozen=True)
class Access:
    """What whoever showed a token may do.

    Attributes:
        scope: the rights.
        token: id of the token; None for the token of the file.
        label: whose it is.
    """

    scope: Scope
    token: str | None
    label: str


LOCAL = Access(Scope.OPERATOR, None, "token file")
"""The holder of the token file: whoever can read it is on this machine."""


class Gate:
    """Decides who may come in, and as what."""

    def __init__(
        self, token: str, allowed_origins: tuple[str, ...] = (), tokens: TokenStore | None = None
    ) -> None:
        """Guard with tokens.

        Args:
            token: the secret of the token file.
            allowed_origins: origins of web pages that are served beside the own address.
            tokens: the tokens of others, if any.
        """
        self._token = token.encode()
        self._allowed_origins = frozenset(allowed_origins)
        self._tokens = tokens

    def access(self, token: str | None) -> Access | None:
        """What a token allows; None where it opens nothing.

        Raises:
            StoreError: the tokens cannot be read.
        """
        if token is None:
            return None
        if hmac.compare_digest(token.encode("utf-8", "surrogatepass"), self._token):
            return LOCAL
        record = self._tokens.opened_by(token) if self._tokens is not None else None
        return None if record is None else Access(record.scope, record.id, record.label)

    def access_by_header(self, authorization: str | None) -> Access | None:
        """What the token of an Authorization header allows; None where it opens nothing.

        Raises:
            StoreError: the tokens cannot be read.
        """
        scheme, _, token = (authorization or "").partition(" ")
        return self.access(token.strip()) if scheme.lower() == "bearer" else None

    def still_holds(self, access: Access) -> bool:
        """Whether what was allowed is allowed now.

        Raises:
            StoreError: the tokens cannot be read.
        """
        return access.token is None or (self._tokens is not None and self._tokens.holds(access.token))

    def accepts_origin(self, origin: str | None, host: str | None) -> bool:
        """Whether a page of this origin may connect; programs that are no browsers send none."""
        if origin is None or origin in self._allowed_origins:
            return True
        return host is not None and origin in (f"http://{host}", f"https://{host}")
