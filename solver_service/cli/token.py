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
from solver_service.web.token_store import TokenStore

DAY_S = 86_400.0


def create_token(label: str, scope: str, days: float | None, data_dir: Path | None) -> None:
    """Write a new token to standard output, and what it is to standard error.

    Raises:
        AccessError: scope, label or days are not allowed.
        StoreError: the token store cannot be used.
    """
    rights = scope_of(scope)
    store = TokenStore(data_dir or default_data_dir())
    try:
        token, record = store.create(label, rights, None if days is None else days * DAY_S)
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
            f"expires {_day(record.expires):<16}  {record.label}"
        )


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


def _day(moment: float | None) -> str:
    return "never" if moment is None else datetime.fromtimestamp(moment, UTC).strftime("%Y-%m-%d %H:%MZ")
