import sqlite3
from contextlib import closing
from pathlib import Path

import pytest

from solver_service.store import RunDatabase
from solver_service.store.schema import SCHEMA, UPGRADES, VERSION

FIRST = """
CREATE TABLE service (key TEXT PRIMARY KEY, value INTEGER NOT NULL) WITHOUT ROWID;
CREATE TABLE runs (
    run TEXT PRIMARY KEY, "case" TEXT NOT NULL, case_fingerprint TEXT NOT NULL, title TEXT NOT NULL,
    parent TEXT REFERENCES runs(run), branch_index INTEGER NOT NULL, status TEXT NOT NULL,
    status_reason TEXT NOT NULL, duration REAL NOT NULL, output_interval REAL NOT NULL, device TEXT NOT NULL,
    bed_revision INTEGER NOT NULL, bed_edits BLOB NOT NULL, facts BLOB NOT NULL);
CREATE TABLE edit_events (
    run TEXT NOT NULL REFERENCES runs(run), sequence INTEGER NOT NULL, kind TEXT NOT NULL, edit BLOB NOT NULL,
    PRIMARY KEY (run, sequence)) WITHOUT ROWID;
CREATE TABLE frames (
    run TEXT NOT NULL REFERENCES runs(run), "index" INTEGER NOT NULL, time REAL NOT NULL, revision INTEGER NOT
    NULL, key_index INTEGER NOT NULL, segment TEXT NOT NULL, "offset" INTEGER NOT NULL, size INTEGER NOT NULL,
    crc32 INTEGER NOT NULL, PRIMARY KEY (run, "index")) WITHOUT ROWID;
CREATE TABLE checkpoints (
    run TEXT NOT NULL REFERENCES runs(run), time REAL NOT NULL, step_count INTEGER NOT NULL, name TEXT NOT
    NULL, crc32 INTEGER NOT NULL, size INTEGER NOT NULL, PRIMARY KEY (run, name));
CREATE TABLE run_events (run TEXT NOT NULL, wall_time REAL NOT NULL, kind TEXT NOT NULL, detail TEXT NOT
NULL); INSERT INTO service VALUES ('epoch', 0);
"""
"""The tables of the first version, as they once were."""


def tables(path: Path) -> dict[str, list[tuple[object, ...]]]:
    """The columns of every table: name, type, not null, default, place in the key."""
    with closing(sqlite3.connect(path)) as database:
        names = [row[0] for row in database.execute("SELECT name FROM sqlite_master WHERE type = 'table'")]
        return {name: sorted(r[1:] for r in database.execute(f"PRAGMA table_info({name})")) for name in names}


def test_a_store_of_the_first_version_gets_the_tables_of_a_new_one_and_keeps_its_runs(tmp_path: Path) -> None:
    old, new = tmp_path / "old.sqlite", tmp_path / "new.sqlite"
    with closing(sqlite3.connect(old)) as database:
        database.executescript(FIRST)
        database.execute(
            "INSERT INTO runs VALUES ('r1', 'c', 'f', 't', NULL, 0, 'paused', '', 9.0, 1.0, 'cpu', 0, ?, ?)",
            (b"\x90", b"\x80"),
        )
        database.execute("PRAGMA user_version = 1")
        database.commit()
    RunDatabase(new).close()
    assert tables(old) != tables(new)

    upgraded = RunDatabase(old)
    (run,) = upgraded.runs()
    assert run.channel_names == ()
    assert run.forcing == b"\x90"
    assert upgraded.forcing_events("r1") == []
    upgraded.close()

    assert (run.run, run.case, run.label, run.pinned, run.owner) == ("r1", "c", "", False, "")
    assert tables(old) == tables(new)


def test_every_version_leads_to_the_next() -> None:
    assert sorted(UPGRADES) == list(range(1, VERSION))
    with closing(sqlite3.connect(":memory:")) as database:
        database.executescript(SCHEMA)


@pytest.mark.parametrize("owner", ["a", "b", ""])
def test_the_bytes_of_an_owner_are_those_of_its_own_runs(tmp_path: Path, owner: str) -> None:
    path = tmp_path / "runs.sqlite"
    database = RunDatabase(path)
    with closing(sqlite3.connect(path)) as rows:
        for run, whose, size in (("r1", "a", 10), ("r2", "b", 200), ("r3", "b", 3000)):
            rows.execute(
                'INSERT INTO runs (run, "case", case_fingerprint, title, branch_index, status, '
                "status_reason, duration, output_interval, device, bed_revision, bed_edits, facts, owner) "
                "VALUES (?, 'c', 'f', 't', 0, 'paused', '', 9.0, 1.0, 'cpu', 0, x'', x'', ?)",
                (run, whose),
            )
            rows.execute("INSERT INTO frames VALUES (?,0,0.0,0,0,'s',0,?,0)", (run, size))
            rows.execute("INSERT INTO channels VALUES (?,0,'maxima','s',?,5,0)", (run, size))
            rows.execute("INSERT INTO checkpoints VALUES (?,0.0,0,'n',0,?)", (run, size + 1))
        rows.commit()
    stored = database.stored_bytes()
    assert sum(each.size for each in stored if each.owner == owner) == {"a": 26, "b": 6412, "": 0}[owner]
    assert {each.kind: each.size for each in stored if each.run == "r2"} == {
        "frames": 200,
        "channels": 5,
        "checkpoints": 201,
    }
    database.close()
