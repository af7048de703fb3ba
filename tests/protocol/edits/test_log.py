import pytest
from hypothesis import given
from hypothesis import strategies as st

from protocol import EditError, EditLine, EditLog, limits
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


def test_a_change_of_any_kind_is_undone_and_redone_in_its_place() -> None:
    log = EditLog([line(AB, id=name) for name in "abc"])
    wide = line(AB, 9.0, id="b")
    log.replace(wide)
    log.delete("a")
    log.append(line(AB, id="d"), line(AB, id="e"))
    assert (ids(log), log.edits[0]) == (["b", "c", "d", "e"], wide)
    log.undo()
    assert ids(log) == ["b", "c"]
    log.undo()
    assert (ids(log), log.edits[1]) == (["a", "b", "c"], wide)
    log.undo()
    assert log.edits[1].width == 2.0
    for _ in range(3):
        log.redo()
    assert (ids(log), log.edits[0], log.revision) == (["b", "c", "d", "e"], wide, 9)


def test_the_undone_edits_are_those_that_redoing_brings_back_the_next_one_first() -> None:
    log = EditLog()
    for name in "abc":
        log.append(line(AB, id=name))
    log.replace(line(AB, 5.0, id="a"))
    log.delete("b")
    assert log.undone == ()
    for _ in range(4):
        log.undo()
    assert ([edit.id for edit in log.undone], ids(log)) == (["b", "c"], ["a"])
    log.redo()
    assert [edit.id for edit in log.undone] == ["c"]
    log.append(line(AB, id="x"))
    assert log.undone == ()


def test_what_is_undone_fits_beside_the_list() -> None:
    log = EditLog()
    for half in "ab":
        log.append(*(line(AB, id=f"{half}{n}") for n in range(limits.MAX_EDITS // 2)))
    log.undo()
    assert len(log.undone) == limits.MAX_EDITS // 2
    log.undo()
    assert len(log.undone) == limits.MAX_EDITS
    many = [(float(n % 7), 0.0) for n in range(limits.MAX_VERTICES)]
    log = EditLog()
    for name in "ab":
        for n in range(limits.MAX_LOG_VERTICES // limits.MAX_VERTICES):
            log.append(line(many, id=f"{name}{n}"))
            log.delete(f"{name}{n}")
    while log.can_undo:
        log.undo()
    assert len(log.undone) == limits.MAX_LOG_VERTICES // limits.MAX_VERTICES


def test_an_edit_that_is_not_in_the_list_is_neither_replaced_nor_deleted() -> None:
    log = EditLog([line(AB, id="a")])
    with pytest.raises(EditError, match="'b' is not in the list"):
        log.replace(line(AB, id="b"))
    with pytest.raises(EditError, match="'b' is not in the list"):
        log.delete("b")
    assert (ids(log), log.revision, log.can_redo) == (["a"], 0, False)


def test_edits_that_come_at_once_come_all_or_none() -> None:
    log = EditLog([line(AB, id="a")])
    with pytest.raises(EditError, match="'a'"):
        log.append(line(AB, id="b"), line(AB, id="a"))
    with pytest.raises(EditError, match="'c'"):
        log.append(line(AB, id="c"), line(AB, id="c"))
    assert (ids(log), log.revision) == (["a"], 0)


def test_an_edit_may_not_grow_beyond_the_vertices_of_a_list() -> None:
    many = [(float(n % 7), 0.0) for n in range(limits.MAX_VERTICES)]
    count = limits.MAX_LOG_VERTICES // limits.MAX_VERTICES
    log = EditLog([*(line(many, id=f"{n}") for n in range(count - 1)), line(AB, id="b"), line(AB, id="c")])
    with pytest.raises(EditError, match="'b'"):
        log.replace(line(many, id="b"))
    log.delete("c")
    log.delete("b")
    log.append(line(many, id="b"))


def test_the_oldest_changes_are_forgotten_when_the_history_is_full() -> None:
    many = [(float(n % 7), 0.0) for n in range(limits.MAX_VERTICES)]
    log = EditLog()
    log.append(line(AB, id="kept"))
    rounds = limits.MAX_HISTORY_VERTICES // limits.MAX_VERTICES
    for n in range(rounds):
        log.append(line(many, id=f"{n}"))
        log.delete(f"{n}")
    undos = 0
    while log.can_undo:
        log.undo()
        undos += 1
    assert (undos, ids(log)) == (rounds, ["kept"])
    while log.can_redo:
        log.redo()
    assert ids(log) == ["kept"]


def test_a_copy_changes_on_its_own() -> None:
    log = EditLog()
    for name in "ab":
        log.append(line(AB, id=name))
    log.undo()
    copy = log.copy()
    copy.redo()
    copy.delete("a")
    assert (ids(log), log.revision, log.can_redo) == (["a"], 3, True)
    assert (ids(copy), copy.revision, copy.can_redo) == (["b"], 5, False)
    assert log.redo() == 4


@given(
    st.lists(
        st.tuples(st.sampled_from(["append", "many", "replace", "delete", "undo", "redo"]), st.integers(0, 9))
    )
)
def test_every_state_of_the_list_comes_back(steps: list[tuple[str, int]]) -> None:
    log = EditLog()
    states: list[tuple[EditLine, ...]] = [()]
    at = 0
    for number, (step, place) in enumerate(steps):
        now = states[at]
        new = line(AB, 3.0 + number, id=f"{number}")
        if step == "undo" and at:
            log.undo()
            at -= 1
        elif step == "redo" and at + 1 < len(states):
            log.redo()
            at += 1
        elif step == "append" or (step == "many" and not now):
            log.append(new)
            states[at + 1 :] = [(*now, new)]
            at += 1
        elif step == "many":
            other = line(AB, id=f"{number}-2")
            log.append(new, other)
            states[at + 1 :] = [(*now, new, other)]
            at += 1
        elif step in ("replace", "delete") and now:
            place %= len(now)
            changed = (line(AB, 3.0 + number, id=now[place].id),) if step == "replace" else ()
            log.replace(changed[0]) if changed else log.delete(now[place].id)
            states[at + 1 :] = [now[:place] + changed + now[place + 1 :]]
            at += 1
        assert log.edits == states[at]
        assert (log.can_undo, log.can_redo) == (at > 0, at + 1 < len(states))
