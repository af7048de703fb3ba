import msgspec
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from protocol import (
    EditArea,
    EditError,
    EditLine,
    EditLog,
    EditType,
    GridGeometry,
    Operation,
    apply_edits,
)
from viewer.world import EditDocument

GRID = GridGeometry(nrows=40, ncols=60, dx=10.0)
BASE = np.linspace(0.0, 20.0, 2400, dtype=np.float32).reshape(40, 60)


def line(name: str, y: float, operation: Operation = Operation.raise_) -> EditLine:
    return EditLine(
        id=name,
        vertices=((105.0, y), (305.0, y)),
        width=30.0,
        operation=operation,
        type=EditType.modulate,
        magnitude=5.0,
    )


@pytest.fixture
def document() -> EditDocument:
    return EditDocument(GRID, BASE)


def test_the_preview_is_what_the_solver_will_apply(document: EditDocument) -> None:
    edits = [line("a", 105.0), line("b", 205.0, Operation.lower)]
    document.mirror(2, edits, can_undo=True, can_redo=False)
    draft = line("c", 155.0)
    document.set_draft(draft)

    assert np.array_equal(document.preview().z_b, apply_edits(BASE, [*edits, draft], GRID).z_b)


def test_raised_cells_are_marked_warm_and_lowered_cells_cool(document: EditDocument) -> None:
    document.mirror(2, [line("a", 105.0), line("b", 205.0, Operation.lower)], can_undo=True, can_redo=False)
    preview = document.preview()

    assert preview.sign[10, 20] == 1
    assert preview.sign[20, 20] == -1
    assert preview.sign[30, 20] == 0
    assert np.array_equal(preview.sign, np.sign(preview.z_b - BASE).astype(np.int8))


def test_nothing_outside_the_dirty_rectangle_changed(document: EditDocument) -> None:
    before = document.preview()
    document.set_draft(line("a", 105.0))
    first = document.preview()
    document.set_draft(line("a", 305.0))
    second = document.preview()
    for earlier, later in ((before, first), (first, second)):
        assert later.dirty is not None
        row0, col0, row1, col1 = later.dirty
        outside = np.ones(BASE.shape, dtype=bool)
        outside[row0:row1, col0:col1] = False
        assert np.array_equal(earlier.z_b[outside], later.z_b[outside])
        assert not np.array_equal(earlier.z_b, later.z_b)


def test_a_dropped_draft_leaves_no_trace(document: EditDocument) -> None:
    document.set_draft(line("a", 105.0))
    document.preview()
    document.set_draft(None)
    preview = document.preview()

    assert np.array_equal(preview.z_b, BASE)
    assert not preview.sign.any()


def test_an_undo_by_the_service_takes_the_edit_off_the_ground(document: EditDocument) -> None:
    document.mirror(1, [line("a", 105.0)], can_undo=True, can_redo=False)
    document.preview()
    document.mirror(2, [], can_undo=False, can_redo=True)

    assert np.array_equal(document.preview().z_b, BASE)
    assert (document.revision, document.can_undo, document.can_redo) == (2, False, True)


def test_while_nothing_changes_the_preview_is_the_same_object(document: EditDocument) -> None:
    document.set_draft(line("a", 105.0))
    preview = document.preview()
    document.set_draft(line("a", 105.0))

    assert document.preview() is preview


def test_the_bed_of_a_run_is_the_base_with_its_own_edits(document: EditDocument) -> None:
    edits = [line("a", 105.0)]

    assert document.bed_of([]) is document.base
    assert np.array_equal(document.bed_of(edits), apply_edits(BASE, edits, GRID).z_b)


def test_an_edit_in_progress_stands_in_the_place_of_the_one_of_its_id(document: EditDocument) -> None:
    level = msgspec.structs.replace(line("b", 105.0), type=EditType.replace, level=12.0)
    edits = [line("a", 105.0), level, line("c", 105.0)]
    document.mirror(3, edits, can_undo=True, can_redo=False)
    document.preview()
    moved = msgspec.structs.replace(level, vertices=((105.0, 205.0), (305.0, 205.0)))
    document.set_draft(moved)
    preview = document.preview()

    assert np.array_equal(preview.z_b, apply_edits(BASE, [edits[0], moved, edits[2]], GRID).z_b)
    assert preview.dirty == (9, 9, 22, 32)  # the old and the new place
    document.set_draft(None)
    assert np.array_equal(document.preview().z_b, apply_edits(BASE, edits, GRID).z_b)


def test_what_a_change_of_the_list_did_is_known_by_the_edits_that_changed(document: EditDocument) -> None:
    far = line("far", 355.0)
    document.mirror(1, [line("a", 105.0), far], can_undo=True, can_redo=False)
    document.preview()
    document.mirror(2, [far], can_undo=True, can_redo=False)
    preview = document.preview()

    assert preview.dirty == (9, 9, 12, 32)  # the deleted one's place alone
    assert not preview.sign[9:12].any()
    assert preview.sign[35, 20] == 1


def test_the_same_edits_in_another_order_make_another_ground(document: EditDocument) -> None:
    level = msgspec.structs.replace(line("b", 105.0), type=EditType.replace, level=12.0)
    document.mirror(2, [line("a", 105.0), level], can_undo=True, can_redo=False)
    document.preview()
    document.mirror(4, [level, line("a", 105.0)], can_undo=True, can_redo=False)
    preview = document.preview()

    assert preview.dirty == (9, 9, 12, 32)
    assert np.array_equal(preview.z_b, apply_edits(BASE, [level, line("a", 105.0)], GRID).z_b)


def test_a_draft_that_does_not_fit_is_refused_and_changes_nothing(document: EditDocument) -> None:
    document.set_draft(line("a", 105.0))
    before = document.preview()
    with pytest.raises(EditError, match="outside"):
        document.set_draft(line("a", 1e5))

    assert document.draft == line("a", 105.0)
    assert document.preview() is before


COORDINATES = st.tuples(st.floats(0.0, 600.0), st.floats(0.0, 400.0))


@st.composite
def any_edits(draw: st.DrawFn, name: str) -> EditLine | EditArea:
    is_area = draw(st.booleans())
    vertices = tuple(draw(st.lists(COORDINATES, min_size=3 if is_area else 2, max_size=6)))
    kind = draw(st.sampled_from(EditType))
    shared = {
        "operation": draw(st.sampled_from(Operation)),
        "type": kind,
        "magnitude": draw(st.floats(0.01, 30.0)),
        "level": draw(st.none() | st.floats(0.0, 30.0)),
        "reference_z": tuple(draw(st.floats(0.0, 20.0)) for _ in vertices),
    }
    if is_area:
        return EditArea(name, vertices, **shared)
    return EditLine(name, vertices, draw(st.floats(0.1, 120.0)), **shared)


@given(st.data())
def test_after_any_changes_the_preview_is_the_bed_of_the_list_and_dirty_holds_what_changed(
    data: st.DataObject,
) -> None:
    document, log = EditDocument(GRID, BASE), EditLog()
    before = document.preview().z_b
    for number in range(data.draw(st.integers(1, 6))):
        step = data.draw(st.sampled_from(["append", "replace", "delete", "undo", "redo", "draft"]))
        names = [edit.id for edit in log.edits]
        draft = None
        if step == "append" or (step in ("replace", "delete") and not names):
            log.append(data.draw(any_edits(f"e{number}")))
        elif step == "replace":
            log.replace(data.draw(any_edits(data.draw(st.sampled_from(names)))))
        elif step == "delete":
            log.delete(data.draw(st.sampled_from(names)))
        elif step == "undo" and log.can_undo:
            log.undo()
        elif step == "redo" and log.can_redo:
            log.redo()
        elif step == "draft":
            draft = data.draw(any_edits(data.draw(st.sampled_from([*names, "new"]))))
        document.set_draft(draft)
        document.mirror(log.revision, log.edits, log.can_undo, log.can_redo, log.undone)
        preview = document.preview()
        expected = EditLog(log.edits)
        if draft is not None:
            expected.replace(draft) if draft.id in names else expected.append(draft)
        assert np.array_equal(preview.z_b, apply_edits(BASE, expected.edits, GRID).z_b)
        assert np.array_equal(preview.sign, np.sign(preview.z_b - BASE))
        changed = before != preview.z_b
        if preview.dirty is not None:
            row0, col0, row1, col1 = preview.dirty
            changed[row0:row1, col0:col1] = False
        assert not changed.any()
        before = preview.z_b
