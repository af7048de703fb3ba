import json
from pathlib import Path

from solver_service.web.scopes import Scope
from solver_service.web.token_store import TokenStore


def test_a_token_is_made_listed_and_revoked(tmp_path: Path, fev_solver) -> None:
    made = fev_solver("token", "create", "Ada of the desk", "--scope", "controller", "--data-dir", tmp_path)
    token = made.out.strip()
    store = TokenStore(tmp_path)
    record = store.opened_by(token)
    assert made.code == 0
    assert record is not None
    assert (record.label, record.scope, record.expires) == ("Ada of the desk", Scope.CONTROLLER, None)

    listed = fev_solver("token", "list", "--data-dir", tmp_path)
    assert record.id in listed.out
    assert "valid" in listed.out
    assert token not in listed.out

    revoked = fev_solver("token", "revoke", record.id, "--data-dir", tmp_path)
    assert revoked.code == 0
    assert store.opened_by(token) is None
    assert "revoked" in fev_solver("token", "list", "--data-dir", tmp_path).out
    store.close()


def test_a_token_can_be_made_for_some_days(tmp_path: Path, fev_solver) -> None:
    fev_solver("token", "create", "guest", "--scope", "viewer", "--days", "2", "--data-dir", tmp_path)
    (row,) = json.loads(fev_solver("token", "list", "--json", "--data-dir", tmp_path).out)["tokens"]

    assert row["expires"] - row["created"] == 2 * 86_400.0
    assert (row["scope"], row["state"], row["label"]) == ("viewer", "valid", "guest")


def test_the_limits_of_a_token_are_made_told_and_replaced(tmp_path: Path, fev_solver) -> None:
    words = ("token", "create", "room", "--scope", "viewer", "--max-runs", "2", "--max-viewers", "0")
    fev_solver(*words, "--data-dir", tmp_path)
    (row,) = json.loads(fev_solver("token", "list", "--json", "--data-dir", tmp_path).out)["tokens"]
    assert {name: value for name, value in row["limits"].items() if value is not None} == {
        "max_runs": 2,
        "max_viewers": 0,
    }
    assert "max_runs 2, max_viewers 0" in fev_solver("token", "list", "--data-dir", tmp_path).out

    told = fev_solver("token", "limit", row["id"], "--max-cells", "5", "--data-dir", tmp_path)
    assert told.code == 0
    (row,) = json.loads(fev_solver("token", "list", "--json", "--data-dir", tmp_path).out)["tokens"]
    assert {name: value for name, value in row["limits"].items() if value is not None} == {"max_cells": 5}


def test_what_cannot_be_is_refused_in_one_sentence_and_makes_nothing(tmp_path: Path, fev_solver) -> None:
    for words in (
        ("create", "x", "--scope", "root"),
        ("create", "x", "--scope", "viewer", "--days", "-1"),
        ("create", "", "--scope", "viewer"),
        ("create", "x", "--scope", "viewer", "--max-runs", "-1"),
        ("revoke", "deadbeef"),
        ("limit", "deadbeef", "--max-runs", "1"),
    ):
        answer = fev_solver("token", *words, "--data-dir", tmp_path)
        assert answer.code == 2, words
        assert len(answer.err.splitlines()) == 1
        assert answer.out == ""
    assert fev_solver("token", "list", "--data-dir", tmp_path).out == ""
