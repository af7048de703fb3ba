import pytest
from hypothesis import given
from hypothesis import strategies as st

from protocol import EditError, EditLog, limits
from tests.protocol.edits.examples import line

AB = [(0.0, 0.0), (1.0, 1.0)]


def ids(log: EditLog) -> list[str]:
    return [edit.id for edit in log.edits]


def test_a_new_log_is_empty() -> None:
    log = EditLog()
    assert (log.edits, log.revision, log.can_undo, log.can_redo) == ((), 0, False, False)


def test_undo_and_redo_move_the_last_edit() -> None:
    log = EditLog()
    for name in ("a", "b"):
        log.append(line(AB, id=name))
    log.undo()
    assert (ids(log), log.can_undo, log.can_redo) == (["a"], True, True)
    log.redo()
    assert (ids(log), log.can_redo) == (["a", "b"], False)


def test_a_new_edit_clears_what_could_be_redone() -> None:
    log = EditLog()
    log.append(line(AB, id="a"))
    log.undo()
    log.append(line(AB, id="b"))
    assert (ids(log), log.can_redo) == (["b"], False)


def test_every_change_adds_one_to_the_revision() -> None:
    log = EditLog()
    revisions = [log.append(line(AB, id="a")), log.append(line(AB, id="b")), log.undo(), log.redo()]
    assert revisions == [1, 2, 3, 4]
    assert log.revision == 4


def test_a_log_goes_on_from_a_list_and_its_revision() -> None:
    log = EditLog([line(AB, id="a")], revision=7)
    assert (ids(log), log.revision, log.can_undo) == (["a"], 7, True)
    assert log.undo() == 8


def test_nothing_to_undo_or_redo_is_refused_and_changes_nothing() -> None:
    log = EditLog()
    with pytest.raises(EditError, match="undo"):
        log.undo()
    with pytest.raises(EditError, match="redo"):
        log.redo()
    assert log.revision == 0


def test_an_id_is_used_once_in_a_list() -> None:
    log = EditLog([line(AB, id="a")])
    with pytest.raises(EditError, match="'a'"):
        log.append(line(AB, id="a"))


def test_a_full_list_takes_no_more() -> None:
    log = EditLog(line(AB, id=f"{n}") for n in range(limits.MAX_EDITS))
    with pytest.raises(EditError, match=str(limits.MAX_EDITS)):
        log.append(line(AB, id="more"))


def test_the_vertices_of_a_list_are_limited() -> None:
    many = [(float(n % 7), 0.0) for n in range(limits.MAX_VERTICES)]
    count = limits.MAX_LOG_VERTICES // limits.MAX_VERTICES
    log = EditLog(line(many, id=f"{n}") for n in range(count))
    with pytest.raises(EditError, match=str(limits.MAX_LOG_VERTICES)):
        log.append(line(AB, id="more"))


@given(st.lists(st.sampled_from(["append", "undo", "redo"]), max_size=40))
def test_the_log_is_a_list_with_a_pointer(steps: list[str]) -> None:
    log = EditLog()
    edits: list[str] = []
    length = 0
    for number, step in enumerate(steps):
        if step == "append":
            log.append(line(AB, id=f"{number}"))
            edits[length:] = [f"{number}"]
            length += 1
        elif step == "undo" and length:
            log.undo()
            length -= 1
        elif step == "redo" and length < len(edits):
            log.redo()
            length += 1
        assert ids(log) == edits[:length]
        assert (log.can_undo, log.can_redo) == (length > 0, length < len(edits))
