"""The tables of the store, and what leads from the tables of an earlier version to the next ones."""

from __future__ import annotations

VERSION = 5

STORED_KINDS = ("frames", "channels", "checkpoints")
"""Tables whose rows stand for bytes in files, each with its `size`."""

_CHANNELS = """
CREATE TABLE channels (
    run TEXT NOT NULL, "index" INTEGER NOT NULL, channel TEXT NOT NULL, segment TEXT NOT NULL,
    "offset" INTEGER NOT NULL, size INTEGER NOT NULL, crc32 INTEGER NOT NULL,
    PRIMARY KEY (run, "index", channel),
    FOREIGN KEY (run, "index") REFERENCES frames(run, "index") ON DELETE CASCADE) WITHOUT ROWID;
CREATE VIEW pieces AS
    SELECT run, segment, "offset", size FROM frames
    UNION ALL SELECT run, segment, "offset", size FROM channels;
"""
"""Channels go with their frames; `pieces` is all that lies in segment files."""

_FORCING = """
CREATE TABLE forcing_events (
    run TEXT NOT NULL REFERENCES runs(run), revision INTEGER NOT NULL, changes BLOB NOT NULL,
    PRIMARY KEY (run, revision)) WITHOUT ROWID;
"""

SCHEMA = (
    """
CREATE TABLE service (key TEXT PRIMARY KEY, value INTEGER NOT NULL) WITHOUT ROWID;
CREATE TABLE runs (
    run TEXT PRIMARY KEY, "case" TEXT NOT NULL, case_fingerprint TEXT NOT NULL, title TEXT NOT NULL,
    parent TEXT REFERENCES runs(run), branch_index INTEGER NOT NULL, status TEXT NOT NULL,
    status_reason TEXT NOT NULL, duration REAL NOT NULL, output_interval REAL NOT NULL, device TEXT NOT NULL,
    bed_revision INTEGER NOT NULL, bed_edits BLOB NOT NULL, facts BLOB NOT NULL,
    label TEXT NOT NULL DEFAULT '', pinned INTEGER NOT NULL DEFAULT 0,
    owner TEXT NOT NULL DEFAULT '', channels TEXT NOT NULL DEFAULT '',
    forcing BLOB NOT NULL DEFAULT x'90');
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
    + _CHANNELS
    + _FORCING
)
UPGRADES = {
    1: """
ALTER TABLE runs ADD COLUMN label TEXT NOT NULL DEFAULT '';
ALTER TABLE runs ADD COLUMN pinned INTEGER NOT NULL DEFAULT 0;
""",
    2: "ALTER TABLE runs ADD COLUMN owner TEXT NOT NULL DEFAULT '';",
    3: f"ALTER TABLE runs ADD COLUMN channels TEXT NOT NULL DEFAULT '';{_CHANNELS}",
    4: f"ALTER TABLE runs ADD COLUMN forcing BLOB NOT NULL DEFAULT x'90';{_FORCING}",
}
"""What leads from a schema to the next one."""
