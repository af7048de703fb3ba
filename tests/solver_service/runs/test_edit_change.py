import msgspec
import pytest

from protocol import EditError, EditLog
from solver_service.runs.edit_change import EditChange
from solver_service.store import EditEventKind
from tests.end_to_end.dam_break import levee

A, B, C = (levee(name) for name in "abc")
HIGHER = msgspec.structs.replace(A, magnitude=9.0, name="Higher")
CHANGES = {
    EditEventKind.APPEND: EditChange(EditEventKind.APPEND, (A,)),
    EditEventKind.APPEND_MANY: EditChange(EditEventKind.APPEND_MANY, (B, C)),
    EditEventKind.REPLACE: EditChange(EditEventKind.REPLACE, (HIGHER,)),
    EditEventKind.DELETE: EditChange(EditEventKind.DELETE, deleted="b"),
    EditEventKind.UNDO: EditChange(EditEventKind.UNDO),
    EditEventKind.REDO: EditChange(EditEventKind.REDO),
}


def test_every_kind_of_change_comes_back_from_its_row() -> None:
    assert set(CHANGES) == set(EditEventKind)
    for sequence, change in enumerate(CHANGES.values(), 1):
        event = change.event("r1", sequence)
        assert (event.run, event.sequence, event.kind) == ("r1", sequence, change.kind)
        assert EditChange.of(event) == change


def test_changes_make_the_list_that_they_say() -> None:
    log = EditLog()
    lists = []
    for change in CHANGES.values():
        change.make(log)
        lists.append(log.edits)
    assert lists == [(A,), (A, B, C), (HIGHER, B, C), (HIGHER, C), (HIGHER, B, C), (HIGHER, C)]
    assert log.revision == len(CHANGES)


def test_a_change_that_the_list_does_not_allow_leaves_it_as_it_was() -> None:
    log = EditLog((A,), 1)
    for kind in (EditEventKind.APPEND, EditEventKind.DELETE, EditEventKind.REDO):
        with pytest.raises(EditError):
            CHANGES[kind].make(log)
    assert (log.edits, log.revision) == ((A,), 1)
