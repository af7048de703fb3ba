import hashlib
import sqlite3
import stat
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import pytest

from solver_service.errors import AccessError, StoreError
from solver_service.web.scopes import Scope
from solver_service.web.token_limits import TokenLimits
from solver_service.web.token_store import FILE_NAME, TokenStore


class Clock:
    def __init__(self) -> None:
        self.now = 1_800_000_000.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def store(tmp_path: Path, clock: Clock) -> Iterator[TokenStore]:
    store = TokenStore(tmp_path / "data", clock)
    yield store
    store.close()


def test_a_token_opens_with_its_scope_and_nothing_else_does(store: TokenStore) -> None:
    token, record = store.create("Ada", Scope.CONTROLLER, None)
    other, _ = store.create("Bob", Scope.VIEWER, None)

    assert store.opened_by(token) == record
    assert record.scope is Scope.CONTROLLER
    assert token != other
    swapped = f"fev-{record.id}-{other.split('-', 2)[2]}"
    for wrong in ("", "fev", f"{token}x", token[:-1], token.upper(), token[4:], swapped, "\ud800", record.id):
        assert store.opened_by(wrong) is None, wrong


def test_no_file_holds_the_token_and_only_its_owner_can_read_them(store: TokenStore) -> None:
    token, _ = store.create("Ada", Scope.ADMIN, None)
    secret = token.split("-", 2)[2]

    assert len(secret) >= 43  # 256 bits in base 64
    files = list(store.path.parent.iterdir())
    assert store.path in files
    assert any(b"Ada" in path.read_bytes() for path in files)
    for path in files:
        assert secret.encode() not in path.read_bytes()
        assert stat.S_IMODE(path.stat().st_mode) == 0o600


def test_a_token_opens_until_it_expires(store: TokenStore, clock: Clock) -> None:
    token, record = store.create("Ada", Scope.VIEWER, 60.0)
    clock.now += 59.9
    assert store.opened_by(token) == record
    assert record.state(clock.now) == "valid"
    clock.now += 0.1
    assert store.opened_by(token) is None
    assert not store.holds(record.id)
    assert record.state(clock.now) == "expired"


def test_a_revoked_token_opens_nothing_in_any_process_that_has_the_file_open(
    store: TokenStore, clock: Clock
) -> None:
    token, record = store.create("Ada", Scope.VIEWER, None)
    kept, kept_record = store.create("Bob", Scope.VIEWER, None)
    other = TokenStore(store.path.parent, clock)
    assert other.opened_by(token) == record

    revoked = store.revoke(record.id)
    clock.now += 5.0
    again = store.revoke(record.id)

    assert again.revoked == revoked.revoked == clock.now - 5.0
    assert other.opened_by(token) is None
    assert not other.holds(record.id)
    assert other.opened_by(kept) == kept_record
    states = {found.id: found.state(clock.now) for found in other.records()}
    assert states == {record.id: "revoked", kept_record.id: "valid"}
    other.close()


def test_a_token_that_is_not_there_cannot_be_revoked(store: TokenStore) -> None:
    with pytest.raises(AccessError, match="there is no token 'deadbeef'"):
        store.revoke("deadbeef")
    assert not store.holds("deadbeef")


@pytest.mark.parametrize(
    ("label", "lifetime_s"), [("", 1.0), ("x" * 101, 1.0), ("a\nb", 1.0), ("a", 0.0), ("a", float("nan"))]
)
def test_a_label_or_lifetime_that_cannot_be_makes_no_token(
    store: TokenStore, label: str, lifetime_s: float
) -> None:
    with pytest.raises(AccessError):
        store.create(label, Scope.VIEWER, lifetime_s)
    assert store.records() == []


def test_a_file_that_is_no_token_store_is_told(tmp_path: Path) -> None:
    (tmp_path / FILE_NAME).write_bytes(b"not a database at all, but long enough to be looked at" * 10)
    with pytest.raises(StoreError, match=r"tokens\.sqlite cannot be used"):
        TokenStore(tmp_path)


def test_a_file_from_before_there_were_limits_keeps_its_tokens_and_takes_limits(tmp_path: Path) -> None:
    with closing(sqlite3.connect(tmp_path / "tokens.sqlite")) as database:
        database.execute(
            "CREATE TABLE tokens (id TEXT PRIMARY KEY, digest TEXT NOT NULL, label TEXT NOT NULL, "
            "scope TEXT NOT NULL, created REAL NOT NULL, expires REAL, revoked REAL) STRICT"
        )
        digest = hashlib.sha256(b"fev-00000000-old").hexdigest()
        database.execute(
            "INSERT INTO tokens VALUES ('00000000', ?, 'a', 'viewer', 1.0, NULL, NULL)", (digest,)
        )
        database.commit()
    store = TokenStore(tmp_path)
    record = store.opened_by("fev-00000000-old")
    assert record is not None
    assert record.limits == TokenLimits()
    assert store.limit("00000000", TokenLimits(max_runs=3)).limits == TokenLimits(max_runs=3)
    with pytest.raises(AccessError, match="there is no token"):
        store.limit("11111111", TokenLimits())
    store.close()
