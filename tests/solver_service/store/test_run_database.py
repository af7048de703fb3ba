from dataclasses import replace
from pathlib import Path

import pytest

from solver_service.errors import StoreError
from solver_service.store import EditEvent, EditEventKind, ForcingEvent, FrameRecord, RunDatabase, RunRecord

RUN = RunRecord("r1", "case", "f00d", "Title", None, 0, "running", "", 100.0, 5.0, "auto", 0, b"[]", b"{}")
FRAME = FrameRecord("r1", 0, 0.0, 0, 0, "000001.segment", 0, 10, 1)


def opened(path: Path) -> RunDatabase:
    database = RunDatabase(path / "runs.sqlite")
    database.begin_epoch()
    return database


def test_what_was_written_is_read_back_by_the_next_service(tmp_path: Path) -> None:
    first = opened(tmp_path)
    first.insert_run(RUN)
    first.insert_run(replace(RUN, run="r2", parent="r1", branch_index=3))
    first.insert_frame(FRAME)
    first.close()
    second = opened(tmp_path)
    assert [run.run for run in second.runs()] == ["r1", "r2"]
    assert second.frames("r1") == [FRAME]
    assert second.epoch == 2
    second.close()


def test_a_writer_of_an_earlier_service_is_refused(tmp_path: Path) -> None:
    first = opened(tmp_path)
    first.insert_run(RUN)
    worker = RunDatabase(tmp_path / "runs.sqlite", first.epoch)
    worker.insert_frame(FRAME)
    second = opened(tmp_path)
    with pytest.raises(StoreError, match="taken over"):
        worker.insert_frame(replace(FRAME, index=1))
    assert second.frames("r1") == [FRAME]
    for database in (first, worker, second):
        database.close()


def test_a_run_whose_history_cannot_be_written_is_not_written_either(tmp_path: Path) -> None:
    database = opened(tmp_path)
    event = EditEvent("r1", 1, EditEventKind.APPEND, b"x")
    with pytest.raises(StoreError, match="UNIQUE"):
        database.insert_run(RUN, (event, event))
    assert database.runs() == []
    database.close()


def test_edit_events_come_back_in_order_and_can_be_copied_to_a_child(tmp_path: Path) -> None:
    database = opened(tmp_path)
    database.insert_run(RUN)
    events = [
        EditEvent("r1", 1, EditEventKind.APPEND, b"a"),
        EditEvent("r1", 2, EditEventKind.UNDO, b""),
        EditEvent("r1", 3, EditEventKind.REDO, b""),
    ]
    for event in events:
        database.append_edit_event(event)
    child = replace(RUN, run="r2", parent="r1")
    database.insert_run(child, database.copied_edit_events("r1", "r2"))
    assert database.edit_events("r1") == events
    assert database.edit_events("r2") == [replace(event, run="r2") for event in events]
    database.close()


def test_active_runs_are_interrupted_and_the_move_is_logged(tmp_path: Path) -> None:
    database = opened(tmp_path)
    database.insert_run(RUN)
    database.insert_run(replace(RUN, run="r2", status="finished"))
    assert database.interrupt_active(("running", "starting"), "paused", "the service ended") == ["r1"]
    assert [run.status for run in database.runs()] == ["paused", "finished"]
    assert database.run_events("r1")[-1].detail == "the service ended"
    database.close()


def test_the_log_of_a_run_keeps_its_order_when_the_clock_jumps(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    database = opened(tmp_path)
    database.insert_run(RUN)
    for day, status in ((9, "running"), (2, "paused"), (30, "starting"), (1, "running")):
        monkeypatch.setattr("time.time", lambda day=day: 86400.0 * day)
        database.set_status("r1", status)
    events = database.run_events("r1")[-4:]
    assert [event.wall_time for event in events] == [86400.0 * day for day in (9, 2, 30, 1)]
    assert [run.status for run in database.runs()] == ["running"]
    database.close()


def test_a_store_of_another_schema_is_refused(tmp_path: Path) -> None:
    database = opened(tmp_path)
    database._db.execute("PRAGMA user_version = 99")
    database.close()
    with pytest.raises(StoreError, match="schema 99"):
        RunDatabase(tmp_path / "runs.sqlite")


def test_a_file_that_is_no_database_is_refused_in_a_sentence(tmp_path: Path) -> None:
    (tmp_path / "runs.sqlite").write_bytes(
        b"not a database, but long enough to be read as a header page" * 20
    )
    with pytest.raises(StoreError, match=r"runs\.sqlite"):
        RunDatabase(tmp_path / "runs.sqlite")


def test_the_working_forcing_is_kept_by_revision_and_goes_with_its_run(tmp_path: Path) -> None:
    database = opened(tmp_path)
    database.insert_run(replace(RUN, forcing=b"\x91x"))
    child = ForcingEvent("r2", 2, b"b")
    database.insert_run(replace(RUN, run="r2", parent="r1"), (), child)
    database.append_forcing_event(ForcingEvent("r1", 1, b"a"))
    database.append_forcing_event(ForcingEvent("r1", 2, b"b"))
    with pytest.raises(StoreError, match="UNIQUE"):
        database.append_forcing_event(ForcingEvent("r1", 2, b"c"))
    assert [event.changes for event in database.forcing_events("r1")] == [b"a", b"b"]
    assert database.forcing_events("r2") == [child]
    assert [run.forcing for run in database.runs()] == [b"\x91x", b"\x90"]
    database.delete_run("r2")
    assert database.forcing_events("r2") == []
    database.close()
