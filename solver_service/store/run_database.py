"""The SQLite side of the store: WAL, synchronous FULL, every change one transaction.

One object belongs to one thread; each process and thread opens its own. Writers of a service that was
declared dead are fenced off: a service takes a new epoch when it opens the store, and a commit with an older
epoch is refused, so that a worker which outlived its service cannot change the past of the next one.
"""

from __future__ import annotations

import sqlite3
import time
from collections.abc import Iterable, Iterator
from contextlib import closing, contextmanager
from dataclasses import astuple, fields, replace
from pathlib import Path

from solver_service.errors import StoreError
from solver_service.store.records import (
    ChannelRecord,
    CheckpointRecord,
    EditEvent,
    EditEventKind,
    ForcingEvent,
    FrameRecord,
    RunEvent,
    RunRecord,
    StoredBytes,
)
from solver_service.store.room import store_failure
from solver_service.store.schema import SCHEMA, STORED_KINDS, UPGRADES, VERSION

BUSY_TIMEOUT_S = 10.0


def _columns(record: type) -> str:
    return ", ".join(f'"{field.name}"' for field in fields(record))


def _marks(record: type) -> str:
    return ", ".join("?" for _ in fields(record))


_RUN = _columns(RunRecord)
_FRAME = _columns(FrameRecord)
_CHANNEL = _columns(ChannelRecord)
_CHECKPOINT = _columns(CheckpointRecord)


class RunDatabase:
    """Runs, edit events, events and commit rows."""

    def __init__(self, path: Path, epoch: int | None = None) -> None:
        """Open, or make, the database.

        Args:
            path: the SQLite file.
            epoch: the epoch of the service for which this object writes; None for the service itself, which
                then
                calls `begin_epoch`, and for readers.

        Raises:
            StoreError: not a store of this schema, or not readable.
        """
        self._path = path
        self.epoch = epoch
        with _told(path):
            self._db = self._connect()
            self._db.execute("PRAGMA journal_mode = WAL")
            version = self._db.execute("PRAGMA user_version").fetchone()[0]
            if version == 0:
                self._db.executescript(f"BEGIN;{SCHEMA}PRAGMA user_version = {VERSION};COMMIT;")
            elif not 0 < version <= VERSION:
                raise StoreError(f"store {path} has schema {version}; this service reads {VERSION}")
            for old in range(max(version, 1), VERSION if version else 0):
                self._db.executescript(f"BEGIN;{UPGRADES[old]}PRAGMA user_version = {old + 1};COMMIT;")

    def close(self) -> None:
        """Close the connection."""
        self._db.close()

    def copy_to(self, path: Path) -> None:
        """Copy the whole database as it is at one moment, while others write to it.

        Raises:
            StoreError: there is no room, or a database is damaged.
        """
        with _told(path), closing(sqlite3.connect(path)) as target:
            self._db.backup(target)

    def faults(self) -> list[str]:
        """What SQLite finds wrong with the database itself."""
        with _told(self._path):
            found = [row[0] for row in self._db.execute("PRAGMA integrity_check").fetchall()]
            orphans = self._db.execute("PRAGMA foreign_key_check").fetchall()
        wrong = [f"store {self._path}: {text}" for text in found if text != "ok"]
        return wrong + [
            f"store {self._path}: table {row[0]} has a row without its {row[2].removesuffix('s')}"
            for row in orphans
        ]

    def begin_epoch(self) -> int:
        """Fence off every writer that was opened before; the service calls it once when it starts."""
        with self._transaction(fenced=False):
            self._db.execute("UPDATE service SET value = value + 1 WHERE key = 'epoch'")
            row = self._db.execute("SELECT value FROM service WHERE key = 'epoch'").fetchone()
        self.epoch = int(row[0])
        return self.epoch

    # runs

    def insert_run(
        self, run: RunRecord, edit_events: tuple[EditEvent, ...] = (), forcing: ForcingEvent | None = None
    ) -> None:
        """Add a run together with the history of its working list of edits and with its working forcing."""
        with self._transaction():
            self._db.execute(f"INSERT INTO runs ({_RUN}) VALUES ({_marks(RunRecord)})", astuple(run))
            for event in edit_events:
                self._insert_edit(event)
            if forcing is not None:
                self._insert_forcing(forcing)
            self._log(
                run.run, "created", f"case {run.case}" + (f", parent {run.parent}" if run.parent else "")
            )

    def set_status(self, run: str, status: str, reason: str = "") -> None:
        """Record a status move."""
        with self._transaction():
            self._db.execute(
                "UPDATE runs SET status = ?, status_reason = ? WHERE run = ?", (status, reason, run)
            )
            self._log(run, status, reason)

    def runs(self) -> list[RunRecord]:
        """All runs in the order in which they were made."""
        with _told(self._path):
            rows = self._db.execute(f"SELECT {_RUN} FROM runs ORDER BY rowid").fetchall()
        records = [RunRecord(*row) for row in rows]
        return [replace(record, pinned=bool(record.pinned)) for record in records]

    def mark_run(self, run: str, label: str, pinned: bool) -> None:
        """Record the name that people gave a run, and whether it is kept whatever the budget."""
        with self._transaction():
            self._db.execute("UPDATE runs SET label = ?, pinned = ? WHERE run = ?", (label, pinned, run))
            self._log(run, "marked", f"label {label!r}, {'pinned' if pinned else 'not pinned'}")

    def delete_run(self, run: str) -> None:
        """Forget a run without children and all that is known of it; its files are removed afterwards."""
        with self._transaction():
            for table in ("frames", "checkpoints", "edit_events", "forcing_events", "run_events", "runs"):
                self._db.execute(f"DELETE FROM {table} WHERE run = ?", (run,))

    def interrupt_active(self, active: tuple[str, ...], status: str, reason: str) -> list[str]:
        """Move every run whose status is in `active` to `status`; for the start after a crash."""
        found = [run.run for run in self.runs() if run.status in active]
        for run in found:
            self.set_status(run, status, reason)
        return found

    # edits

    def append_edit_event(self, event: EditEvent) -> None:
        """Record one change of a working list; when this returns the change is safe."""
        with self._transaction():
            self._insert_edit(event)

    def edit_events(self, run: str) -> list[EditEvent]:
        """The changes of the working list of a run in order."""
        with _told(self._path):
            rows = self._db.execute(
                "SELECT run, sequence, kind, edit FROM edit_events WHERE run = ? ORDER BY sequence", (run,)
            ).fetchall()
        return [EditEvent(name, sequence, EditEventKind(kind), edit) for name, sequence, kind, edit in rows]

    def copied_edit_events(self, run: str, child: str) -> tuple[EditEvent, ...]:
        """The history of a run under the name of its child."""
        return tuple(replace(event, run=child) for event in self.edit_events(run))

    # forcing

    def append_forcing_event(self, event: ForcingEvent) -> None:
        """Record one change of a working forcing; when this returns the change is safe."""
        with self._transaction():
            self._insert_forcing(event)

    def forcing_events(self, run: str) -> list[ForcingEvent]:
        """The changes of the working forcing of a run in order."""
        with _told(self._path):
            rows = self._db.execute(
                "SELECT run, revision, changes FROM forcing_events WHERE run = ? ORDER BY revision", (run,)
            ).fetchall()
        return [ForcingEvent(*row) for row in rows]

    # frames and checkpoints

    def insert_frame(self, frame: FrameRecord, channels: Iterable[ChannelRecord] = ()) -> None:
        """The commit of a frame and its channels: from here on they exist."""
        with self._transaction():
            self._db.execute(f"INSERT INTO frames ({_FRAME}) VALUES ({_marks(FrameRecord)})", astuple(frame))
            self._db.executemany(
                f"INSERT INTO channels ({_CHANNEL}) VALUES ({_marks(ChannelRecord)})",
                [astuple(channel) for channel in channels],
            )

    def frames(self, run: str) -> list[FrameRecord]:
        """The frames of one run by index."""
        with _told(self._path):
            rows = self._db.execute(
                f'SELECT {_FRAME} FROM frames WHERE run = ? ORDER BY "index"', (run,)
            ).fetchall()
        return [FrameRecord(*row) for row in rows]

    def frame(self, run: str, index: int) -> FrameRecord | None:
        """One frame of a run, or None."""
        with _told(self._path):
            row = self._db.execute(
                f'SELECT {_FRAME} FROM frames WHERE run = ? AND "index" = ?', (run, index)
            ).fetchone()
        return None if row is None else FrameRecord(*row)

    def last_frame(self, run: str) -> FrameRecord | None:
        """The frame of a run with the highest index, or None."""
        with _told(self._path):
            row = self._db.execute(
                f'SELECT {_FRAME} FROM frames WHERE run = ? ORDER BY "index" DESC LIMIT 1', (run,)
            ).fetchone()
        return None if row is None else FrameRecord(*row)

    def channels(self, run: str) -> list[ChannelRecord]:
        """The channels of the frames of one run, by index."""
        with _told(self._path):
            rows = self._db.execute(
                f'SELECT {_CHANNEL} FROM channels WHERE run = ? ORDER BY "index", channel', (run,)
            ).fetchall()
        return [ChannelRecord(*row) for row in rows]

    def channel_rows(self, run: str, channel: str, first: int, end: int) -> list[ChannelRecord]:
        """The channels of a name of the frames of a run from an index up to before another, by index."""
        with _told(self._path):
            rows = self._db.execute(
                f"SELECT {_CHANNEL} FROM channels WHERE run = ? AND channel = ? "
                'AND "index" >= ? AND "index" < ? ORDER BY "index"',
                (run, channel, first, end),
            ).fetchall()
        return [ChannelRecord(*row) for row in rows]

    def newest_channel(self, run: str, index: int, channel: str) -> ChannelRecord | None:
        """The newest channel of a name that belongs to a frame of a run at or before an index, or None."""
        with _told(self._path):
            row = self._db.execute(
                f'SELECT {_CHANNEL} FROM channels WHERE run = ? AND "index" <= ? AND channel = ? '
                'ORDER BY "index" DESC LIMIT 1',
                (run, index, channel),
            ).fetchone()
        return None if row is None else ChannelRecord(*row)

    def delete_channel(self, channel: ChannelRecord) -> None:
        """Forget a channel of a frame."""
        with self._transaction():
            self._db.execute(
                'DELETE FROM channels WHERE run = ? AND "index" = ? AND channel = ?',
                (channel.run, channel.index, channel.channel),
            )

    def move_frames(self, frames: list[FrameRecord], channels: list[ChannelRecord]) -> None:
        """Record that the bytes of frames and channels lie elsewhere now, all at once."""
        with self._transaction():
            self._db.executemany(
                'UPDATE frames SET segment = ?, "offset" = ? WHERE run = ? AND "index" = ?',
                [(frame.segment, frame.offset, frame.run, frame.index) for frame in frames],
            )
            self._db.executemany(
                'UPDATE channels SET segment = ?, "offset" = ? WHERE run = ? AND "index" = ? AND channel = ?',
                [(each.segment, each.offset, each.run, each.index, each.channel) for each in channels],
            )

    def delete_frames_from(self, run: str, index: int) -> int:
        """Forget the frames of a run from an index on; gives how many."""
        with self._transaction():
            found = self._db.execute('DELETE FROM frames WHERE run = ? AND "index" >= ?', (run, index))
            self._log(run, "truncated", f"from frame {index} on")
        return found.rowcount

    def stored_bytes(self) -> list[StoredBytes]:
        """Size of what every run has stored, by kind."""
        kinds = " UNION ALL ".join(f"SELECT run, '{kind}' AS kind, size FROM {kind}" for kind in STORED_KINDS)
        with _told(self._path):
            rows = self._db.execute(
                f"SELECT run, owner, kind, SUM(size) FROM ({kinds}) JOIN runs USING (run) GROUP BY run, kind"
            ).fetchall()
        return [StoredBytes(*row) for row in rows]

    def segment_ends(self, run: str) -> dict[str, int]:
        """Committed length of every segment file of a run."""
        with _told(self._path):
            rows = self._db.execute(
                'SELECT segment, MAX("offset" + size) FROM pieces WHERE run = ? GROUP BY segment', (run,)
            ).fetchall()
        return {str(segment): int(end) for segment, end in rows}

    def insert_checkpoint(self, checkpoint: CheckpointRecord) -> None:
        """The commit of a checkpoint."""
        with self._transaction():
            self._db.execute(
                f"INSERT INTO checkpoints ({_CHECKPOINT}) VALUES ({_marks(CheckpointRecord)})",
                astuple(checkpoint),
            )

    def delete_checkpoint(self, checkpoint: CheckpointRecord) -> None:
        """Forget a checkpoint; its folder is removed afterwards."""
        with self._transaction():
            self._db.execute(
                "DELETE FROM checkpoints WHERE run = ? AND name = ?", (checkpoint.run, checkpoint.name)
            )

    def checkpoints(self, run: str) -> list[CheckpointRecord]:
        """The checkpoints of a run, earliest first."""
        with _told(self._path):
            rows = self._db.execute(
                f"SELECT {_CHECKPOINT} FROM checkpoints WHERE run = ? ORDER BY step_count, name", (run,)
            ).fetchall()
        return [CheckpointRecord(*row) for row in rows]

    # events

    def log(self, run: str, kind: str, detail: str) -> None:
        """Add a line to the log of a run."""
        with self._transaction():
            self._log(run, kind, detail)

    def run_events(self, run: str) -> list[RunEvent]:
        """The log of a run in order."""
        with _told(self._path):
            rows = self._db.execute(
                "SELECT run, wall_time, kind, detail FROM run_events WHERE run = ? ORDER BY rowid", (run,)
            ).fetchall()
        return [RunEvent(*row) for row in rows]

    def _insert_forcing(self, event: ForcingEvent) -> None:
        self._db.execute("INSERT INTO forcing_events VALUES (?, ?, ?)", astuple(event))

    def _insert_edit(self, event: EditEvent) -> None:
        self._db.execute(
            "INSERT INTO edit_events (run, sequence, kind, edit) VALUES (?, ?, ?, ?)",
            (event.run, event.sequence, event.kind.value, event.edit),
        )

    def _log(self, run: str, kind: str, detail: str) -> None:
        self._db.execute("INSERT INTO run_events VALUES (?, ?, ?, ?)", (run, time.time(), kind, detail))

    @contextmanager
    def _transaction(self, fenced: bool = True) -> Iterator[None]:
        with _told(self._path):
            try:
                self._db.execute("BEGIN IMMEDIATE")
                if fenced:
                    self._check_epoch()
                yield
                self._db.execute("COMMIT")
            except sqlite3.OperationalError:
                # after a failed write even ROLLBACK may fail, and the connection would keep its lock for ever
                self._db.close()
                self._db = self._connect()
                raise
            except BaseException:
                if self._db.in_transaction:
                    self._db.execute("ROLLBACK")
                raise

    def _connect(self) -> sqlite3.Connection:
        connection = sqlite3.connect(
            self._path, timeout=BUSY_TIMEOUT_S, isolation_level=None, check_same_thread=False
        )
        connection.execute("PRAGMA synchronous = FULL")
        connection.execute("PRAGMA foreign_keys = ON")
        return connection

    def _check_epoch(self) -> None:
        current = self._db.execute("SELECT value FROM service WHERE key = 'epoch'").fetchone()[0]
        if current != self.epoch:
            raise StoreError(
                f"store {self._path} was taken over by another service (epoch {current}, ours {self.epoch})"
            )


@contextmanager
def _told(path: Path) -> Iterator[None]:
    """Turn what SQLite raises into one sentence."""
    try:
        yield
    except sqlite3.Error as error:
        raise store_failure(error, f"store {path}") from error
