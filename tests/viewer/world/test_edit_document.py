import numpy as np
import pytest

from protocol import EditLine, EditType, GridGeometry, Operation, apply_edits
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
