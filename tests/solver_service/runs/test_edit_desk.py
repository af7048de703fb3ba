import msgspec
import pytest

from protocol import EditError, EditsChanged
from solver_service.runs.run_tree import replayed_log
from solver_service.store import DataFolder, RunDatabase
from tests.end_to_end.dam_break import levee
from tests.solver_service.runs.conftest import Service


def test_a_change_counts_once_it_is_stored_and_a_refused_one_changes_nothing(service: Service) -> None:
    registry = service.registry
    run = service.call(registry.control.start("dam-break", paused=True))
    assert service.call(registry.edits.append(run.run, levee("a"))) == 1
    with pytest.raises(EditError):
        service.call(registry.edits.append(run.run, levee("a")))
    with pytest.raises(EditError, match="no edit to redo"):
        service.call(registry.edits.redo(run.run))
    assert service.call(registry.edits.undo(run.run)) == 2
    assert service.call(registry.edits.redo(run.run)) == 3
    told = [m for m in service.heard if isinstance(m, EditsChanged) and m.run == run.run]
    assert [(m.revision, [e.id for e in m.edits], m.can_undo, m.can_redo) for m in told] == [
        (1, ["a"], True, False),
        (2, [], False, True),
        (3, ["a"], True, False),
    ]
    assert registry.edits.changed(run.run) == told[-1]
    service.call(registry.control.stop(run.run))


def test_edits_are_added_at_once_replaced_and_deleted_and_come_back_with_the_service(
    service: Service,
) -> None:
    registry = service.registry
    run = service.call(registry.control.start("dam-break", paused=True))
    a, b, c = levee("a"), levee("b", y=500.0), levee("c", y=700.0)
    high = msgspec.structs.replace(b, magnitude=7.0, name="High levee")
    assert service.call(registry.edits.append(run.run, a, b, c)) == 1
    assert service.call(registry.edits.replace(run.run, high)) == 2
    assert service.call(registry.edits.delete(run.run, "a")) == 3
    for refused in (registry.edits.delete(run.run, "a"), registry.edits.replace(run.run, a)):
        with pytest.raises(EditError, match="'a' is not in the list"):
            service.call(refused)
    with pytest.raises(EditError, match="outside"):
        service.call(registry.edits.replace(run.run, levee("b", y=1e6)))
    assert registry.edits.changed(run.run).edits == (high, c)
    assert service.call(registry.edits.undo(run.run)) == 4
    assert service.call(registry.edits.undo(run.run)) == 5
    assert service.call(registry.edits.undo(run.run)) == 6
    told = registry.edits.changed(run.run)
    assert (told.edits, told.undone, told.can_undo, told.can_redo) == ((), (a, b, c), False, True)
    assert service.call(registry.edits.redo(run.run)) == 7
    assert service.call(registry.edits.redo(run.run)) == 8
    database = RunDatabase(DataFolder(registry._folder.root).database)
    try:
        stored = replayed_log(database.edit_events(run.run))
    finally:
        database.close()
    assert (stored.edits, stored.undone, stored.revision) == ((a, high, c), (), 8)
    assert stored.can_redo
    service.call(registry.control.stop(run.run))
