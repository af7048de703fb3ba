import stat
from pathlib import Path

import pytest

from solver_service.errors import ServeError
from solver_service.web.auth import LOCAL, Access, Gate, load_token
from solver_service.web.scopes import Scope
from solver_service.web.token_store import TokenStore

TOKEN = "0123456789abcdefghij"


def test_a_token_is_made_once_and_only_its_owner_can_read_it(tmp_path: Path) -> None:
    path = tmp_path / "deep" / "token"
    token = load_token(path)
    assert len(token) >= 43  # 256 bits in base 64
    assert stat.S_IMODE(path.stat().st_mode) == 0o600
    assert load_token(path) == token
    assert load_token(tmp_path / "other") != token


@pytest.mark.parametrize("content", ["", "short", "with a space in the middle of it", "\xff" * 30])
def test_a_file_that_holds_no_token_is_refused(tmp_path: Path, content: str) -> None:
    path = tmp_path / "token"
    path.write_text(content, encoding="latin-1")
    with pytest.raises(ServeError, match="token file"):
        load_token(path)


@pytest.mark.parametrize(
    ("header", "accepted"),
    [
        (f"Bearer {TOKEN}", True),
        (f"bearer {TOKEN}", True),
        (f"Bearer {TOKEN}x", False),
        (f"Bearer {TOKEN[:-1]}", False),
        (f"Basic {TOKEN}", False),
        (TOKEN, False),
        ("Bearer \u00e9", False),
        ("", False),
        (None, False),
    ],
)
def test_a_header_is_accepted_only_with_the_very_token(header: str | None, accepted: bool) -> None:
    assert (Gate(TOKEN).access_by_header(header) is LOCAL) is accepted


@pytest.mark.parametrize(
    ("origin", "accepted"),
    [
        (None, True),
        ("http://127.0.0.1:8000", True),
        ("https://127.0.0.1:8000", True),
        ("https://map.example", True),
        ("https://evil.example", False),
        ("http://127.0.0.1:8001", False),
        ("null", False),
    ],
)
def test_pages_of_strangers_are_refused(origin: str | None, accepted: bool) -> None:
    gate = Gate(TOKEN, ("https://map.example",))
    assert gate.accepts_origin(origin, "127.0.0.1:8000") is accepted


def test_a_token_of_the_store_opens_with_its_scope_beside_the_token_of_the_file(tmp_path: Path) -> None:
    store = TokenStore(tmp_path)
    token, record = store.create("Ada", Scope.VIEWER, None)
    gate = Gate(TOKEN, tokens=store)

    ada = gate.access_by_header(f"Bearer {token}")
    assert ada == Access(Scope.VIEWER, record.id, "Ada")
    assert gate.access(TOKEN) == LOCAL
    assert LOCAL.scope is Scope.OPERATOR
    assert gate.access(None) is None
    assert gate.access(f"{token}x") is None
    assert Gate(TOKEN).access(token) is None
    assert gate.still_holds(ada)
    store.revoke(record.id)
    assert not gate.still_holds(ada)
    assert gate.access(token) is None
    assert gate.still_holds(LOCAL)
    store.close()
