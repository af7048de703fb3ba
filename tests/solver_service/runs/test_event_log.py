from dataclasses import replace
from pathlib import Path

import msgspec
import pytest

from solver_service.errors import StoreError
from solver_service.runs import RunStatus
from solver_service.runs.event_log import (
    EventLog,
    LoggedEdit,
    is_same,
    parse_event_log,
    read_event_log,
    replay,
)
from solver_service.store import DataFolder, RunDatabase
from tests.end_to_end.dam_break import levee, write_dam_break
from tests.solver_service.runs.conftest import Service


@pytest.fixture(scope="module")
def log(service: Service) -> EventLog:
    """The log of a run that branched twice, with edits, pauses and a killed worker in its past."""
    registry = service.registry
    root = service.call(registry.control.start("dam-break", 200.0))
    service.call(registry.edits.append(root.run, levee("a")))
    service.wait(lambda: root.frame_count > 8)
    child = service.call(registry.branching.recalculate(root.run, 6, 1))
    service.wait(lambda: child.frame_count > 10)
    service.call(registry.edits.undo(child.run))
    service.call(registry.edits.append(child.run, levee("b", y=400.0), levee("c", y=300.0)))
    service.call(registry.edits.replace(child.run, levee("b", y=500.0)))
    service.call(registry.edits.delete(child.run, "c"))
    run = service.call(registry.branching.recalculate(child.run, 9, 5))
    service.wait(lambda: run.frame_count > 12)
    if run.worker is not None:
        run.worker.kill()
    service.wait_for_status(run, RunStatus.FINISHED)
    database = RunDatabase(DataFolder(registry._folder.root).database)
    try:
        service.wait(lambda: database.run_events(run.run)[-1].kind == "finished")
        return read_event_log(database, run.run)
    finally:
        database.close()


def test_the_frames_computed_from_a_log_have_the_very_bytes_of_the_run(log: EventLog, case: str) -> None:
    frames = list(replay(log, case, threads=1))
    assert [frame.index for frame, _ in frames] == list(range(9, 41))
    assert all(is_same(frame, packed) for frame, packed in frames)


def test_a_log_without_its_edit_gives_other_bytes(log: EventLog, case: str) -> None:
    legs = (*log.run.legs[:-1], msgspec.structs.replace(log.run.legs[-1], edits=()))
    other = replace(log, run=msgspec.structs.replace(log.run, legs=legs))
    assert not all(is_same(frame, packed) for frame, packed in replay(other, case, threads=1))


def test_a_log_survives_its_text_and_tells_what_happened(log: EventLog) -> None:
    assert parse_event_log(log.lines()) == log
    assert [leg.first_index for leg in log.run.legs] == [0, 6, 9]
    assert [[edit.id for edit in leg.edits] for leg in log.run.legs] == [[], ["a"], ["b"]]
    edits = [event for event in log.events if isinstance(event, LoggedEdit)]
    assert [(event.kind, event.edit and event.edit.id) for event in edits] == [
        ("append", "a"),
        ("undo", None),
        ("append_many", None),
        ("replace", "b"),
        ("delete", None),
    ]
    assert [edit.id for edit in edits[2].edits] == ["b", "c"]
    assert edits[4].deleted == "c"
    moves = [event.kind for event in log.events if hasattr(event, "wall_time")]
    assert (moves[0], moves[-1]) == ("created", "finished")


def test_another_case_and_a_text_that_is_no_log_are_refused(log: EventLog, tmp_path: Path) -> None:
    other = write_dam_break(tmp_path / "other", duration=123.0)
    (other / "case.toml").write_text((other / "case.toml").read_text().replace("0.035", "0.036"))
    with pytest.raises(StoreError, match="is not the one that run"):
        next(replay(log, str(other)))
    for text in (b"", b"{}", b'{"type": "frame", "index": 1, "size": 2, "crc32": 3}', b"not json"):
        with pytest.raises(StoreError, match="no event log"):
            parse_event_log(text)
