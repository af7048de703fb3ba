"""`fev-solver token`: make, list and revoke the tokens of a data folder, also while a service runs."""

from __future__ import annotations

import json
import sys
import time
from dataclasses import asdict
from datetime import UTC, datetime
from pathlib import Path

from solver_service.store import default_data_dir
from solver_service.web.scopes import scope_of
from solver_service.web.token_limits import TokenLimits
from solver_service.web.token_store import TokenStore

DAY_S = 86_400.0


def create_token(
    label: str, scope: str, days: float | None, data_dir: Path | None, **limits: int | None
) -> None:
    """Write a new token to standard output, and what it is to standard error.

    Args:
        label: whose it is.
        scope: name of its scope.
        days: until it expires; None for never.
        data_dir: the data folder; None for the user's own.
        limits: fields of `TokenLimits`; None where the service's own count.

    Raises:
        AccessError: scope, label, days or a limit are not allowed.
        StoreError: the token store cannot be used.
    """
    rights, allowed = scope_of(scope), TokenLimits(**limits)
    store = TokenStore(data_dir or default_data_dir())
    try:
        token, record = store.create(label, rights, None if days is None else days * DAY_S, allowed)
    finally:
        store.close()
    print(token)
    print(f"token {record.id} ({record.scope}), expires: {_day(record.expires)}", file=sys.stderr)


def list_tokens(data_dir: Path | None, json_line: bool) -> None:
    """Write one line a token, or one JSON object with all.

    Raises:
        StoreError: the token store cannot be used.
    """
    store = TokenStore(data_dir or default_data_dir())
    try:
        records = store.records()
    finally:
        store.close()
    now = time.time()
    if json_line:
        rows = [{**asdict(r), "scope": str(r.scope), "state": r.state(now)} for r in records]
        print(json.dumps({"tokens": rows}))
        return
    for record in records:
        print(
            f"{record.id}  {record.scope!s:<10}  {record.state(now):<7}  "
            f"expires {_day(record.expires):<16}  {record.label}  ({_limits(record.limits)})"
        )


def limit_token(name: str, data_dir: Path | None, **limits: int | None) -> None:
    """Give a token other limits; a service that runs takes them at once.

    Raises:
        AccessError: there is no such token, or a limit is not allowed.
        StoreError: the token store cannot be used.
    """
    allowed = TokenLimits(**limits)
    store = TokenStore(data_dir or default_data_dir())
    try:
        record = store.limit(name, allowed)
    finally:
        store.close()
    print(f"token {record.id} ({record.label}): {_limits(record.limits)}")


def revoke_token(name: str, data_dir: Path | None) -> None:
    """End a token for good.

    Raises:
        AccessError: there is no such token.
        StoreError: the token store cannot be used.
    """
    store = TokenStore(data_dir or default_data_dir())
    try:
        record = store.revoke(name)
    finally:
        store.close()
    print(f"token {record.id} ({record.label}) is revoked")


def _limits(limits: TokenLimits) -> str:
    said = ", ".join(f"{name} {value}" for name, value in limits.items() if value is not None)
    return said or "limits of the service"


def _day(moment: float | None) -> str:
    return "never" if moment is None else datetime.fromtimestamp(moment, UTC).strftime("%Y-%m-%d %H:%MZ")
