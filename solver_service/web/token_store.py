"""Tokens of people and programs: in a SQLite file of their own, hashed, with scope, expiry and revocation.

A token is `fev-ID-SECRET` with 256 random bits of secret. The file keeps the SHA-256 of the whole
token: a slow hash would not protect better what cannot be guessed anyway. The commands write
the file while a service reads it. Beside each token stands how much its holder may take.
"""

from __future__ import annotations

import hashlib
import hmac
import os
import secrets
import sqlite3
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from solver_service.errors import AccessError, StoreError
from solver_service.web.scopes import Scope, scope_of
from solver_service.web.token_limits import NAMES, TokenLimits

FILE_NAME = "tokens.sqlite"
SECRET_BYTES = 32
ID_BYTES = 4
LONGEST_LABEL = 100

_SCHEMA = """
CREATE TABLE IF NOT EXISTS tokens (
    id TEXT PRIMARY KEY,
    digest TEXT NOT NULL,
    label TEXT NOT NULL,
    scope TEXT NOT NULL,
    created REAL NOT NULL,
    expires REAL,
    revoked REAL
) STRICT
"""
_COLUMNS = f"id, label, scope, created, expires, revoked, {', '.join(NAMES)}"


@dataclass(frozen=True)
class TokenRecord:
    """What is known of a token; not the token.

    Attributes:
        id: its name.
        label: whose it is.
        scope: what it allows.
        created: when it was made [s since 1970].
        expires: when it ends [s since 1970], or None for never.
        revoked: when it was revoked [s since 1970], or None.
        limits: how much its holder may take; the service's own limits where it says nothing.
    """

    id: str
    label: str
    scope: Scope
    created: float
    expires: float | None
    revoked: float | None
    limits: TokenLimits = field(default_factory=TokenLimits)

    def holds(self, now: float) -> bool:
        """Whether it opens the door at a time [s since 1970]."""
        return self.revoked is None and (self.expires is None or now < self.expires)

    def state(self, now: float) -> str:
        """How it stands: valid, expired or revoked."""
        if self.revoked is not None:
            return "revoked"
        return "valid" if self.holds(now) else "expired"


class TokenStore:
    """The tokens of a data folder; may be called from any thread."""

    def __init__(self, data_dir: Path, clock: Callable[[], float] = time.time) -> None:
        """Open the file, which is made (mode 600) where there is none.

        Args:
            data_dir: the data folder.
            clock: gives the time now [s since 1970].

        Raises:
            StoreError: the file cannot be used.
        """
        self.path = data_dir / FILE_NAME
        self._clock = clock
        self._lock = threading.Lock()
        try:
            data_dir.mkdir(parents=True, exist_ok=True)
            os.close(os.open(self.path, os.O_RDWR | os.O_CREAT, 0o600))
            self._database = sqlite3.connect(self.path, check_same_thread=False)
        except (OSError, sqlite3.Error) as error:
            raise StoreError(f"token store {self.path} cannot be used: {error}") from error
        try:
            with self._transaction() as database:
                database.execute("PRAGMA journal_mode = WAL")
                database.execute(_SCHEMA)
                _add_limits(database)
        except StoreError:
            self.close()
            raise

    def close(self) -> None:
        """Close the file."""
        self._database.close()

    def create(
        self, label: str, scope: Scope, lifetime_s: float | None, limits: TokenLimits | None = None
    ) -> tuple[str, TokenRecord]:
        """Make a token.

        Args:
            label: whose it is.
            scope: what it allows.
            lifetime_s: how long it opens the door [s], or None for ever.
            limits: how much its holder may take; None for what the service allows to everybody.

        Returns:
            The token, which is kept nowhere, and what is known of it.

        Raises:
            AccessError: the label or the lifetime is not allowed.
            StoreError: the file cannot be written.
        """
        if not (0 < len(label) <= LONGEST_LABEL and label.isprintable()):
            raise AccessError(f"label {label!r} is not 1 to {LONGEST_LABEL} printable characters")
        if lifetime_s is not None and not 0 < lifetime_s < 1e11:
            raise AccessError(f"a lifetime of {lifetime_s:g} s is not allowed; it must be above 0 s")
        now = self._clock()
        expires = None if lifetime_s is None else now + lifetime_s
        limits = limits or TokenLimits()
        record = TokenRecord(secrets.token_hex(ID_BYTES), label, scope, now, expires, None, limits)
        token = f"fev-{record.id}-{secrets.token_urlsafe(SECRET_BYTES)}"
        row = (record.id, label, str(scope), now, expires, None, *(value for _, value in limits.items()))
        marks = ", ".join("?" for _ in row)
        with self._transaction() as database:
            database.execute(
                f"INSERT INTO tokens ({_COLUMNS}, digest) VALUES ({marks}, ?)", (*row, _digest(token))
            )
        return token, record

    def limit(self, name: str, limits: TokenLimits) -> TokenRecord:
        """Give a token other limits, which count from now on.

        Raises:
            AccessError: there is no such token.
            StoreError: the file cannot be written.
        """
        changes = ", ".join(f"{column} = ?" for column in NAMES)
        with self._transaction() as database:
            database.execute(
                f"UPDATE tokens SET {changes} WHERE id = ?", (*(value for _, value in limits.items()), name)
            )
        return self.known(name)

    def records(self) -> list[TokenRecord]:
        """All tokens, oldest first.

        Raises:
            StoreError: the file cannot be read.
        """
        with self._transaction() as database:
            rows = database.execute(f"SELECT {_COLUMNS} FROM tokens ORDER BY created, id").fetchall()
        return [_record(row) for row in rows]

    def revoke(self, name: str) -> TokenRecord:
        """End a token for good; ending it again changes nothing.

        Raises:
            AccessError: there is no such token.
            StoreError: the file cannot be written.
        """
        with self._transaction() as database:
            database.execute(
                "UPDATE tokens SET revoked = ? WHERE id = ? AND revoked IS NULL", (self._clock(), name)
            )
        return self.known(name)

    def known(self, name: str) -> TokenRecord:
        """The record of a token, also of one that has ended.

        Raises:
            AccessError: there is no such token.
            StoreError: the file cannot be read.
        """
        record = self._find(name)
        if record is None:
            raise AccessError(f"there is no token {name!r}; `fev-solver token list` tells their ids")
        return record

    def opened_by(self, token: str) -> TokenRecord | None:
        """The record of a token that holds now; None for any other text.

        Raises:
            StoreError: the file cannot be read.
        """
        head, _, rest = token.partition("-")
        name = rest.partition("-")[0]
        with self._transaction() as database:
            row = database.execute("SELECT digest FROM tokens WHERE id = ?", (name,)).fetchone()
        # compared also where there is no such id, so that the time tells nothing of the ids there are
        known = row[0] if row is not None else _digest("")
        is_same = hmac.compare_digest(known, _digest(token))
        if row is None or not is_same or head != "fev":
            return None
        return self._find(name) if self.holds(name) else None

    def holds(self, name: str) -> bool:
        """Whether a token still opens the door.

        Raises:
            StoreError: the file cannot be read.
        """
        record = self._find(name)
        return record is not None and record.holds(self._clock())

    def _find(self, name: str) -> TokenRecord | None:
        with self._transaction() as database:
            row = database.execute(f"SELECT {_COLUMNS} FROM tokens WHERE id = ?", (name,)).fetchone()
        return None if row is None else _record(row)

    @contextmanager
    def _transaction(self) -> Iterator[sqlite3.Connection]:
        try:
            with self._lock, self._database:
                yield self._database
        except sqlite3.Error as error:
            raise StoreError(f"token store {self.path} cannot be used: {error}") from error


def _digest(token: str) -> str:
    return hashlib.sha256(token.encode("utf-8", "surrogatepass")).hexdigest()


def _add_limits(database: sqlite3.Connection) -> None:
    """Give a file that was made before there were limits their columns."""
    there = {row[1] for row in database.execute("PRAGMA table_info(tokens)").fetchall()}
    for column in NAMES:
        if column not in there:
            database.execute(f"ALTER TABLE tokens ADD COLUMN {column} INTEGER")


def _record(row: tuple[Any, ...]) -> TokenRecord:
    name, label, scope, created, expires, revoked, *limits = row
    return TokenRecord(name, label, scope_of(scope), created, expires, revoked, TokenLimits(*limits))
