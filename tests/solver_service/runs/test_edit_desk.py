import pytest

from protocol import EditError, EditsChanged
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
