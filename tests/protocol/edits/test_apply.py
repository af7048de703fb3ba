"""The formulas of an edit, cell by cell."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from protocol import Edit, EditError, GridGeometry, apply_edits, rasterise_edit
from tests.protocol.edits.examples import area, line

GRID = GridGeometry(nrows=20, ncols=30, dx=2.0, datum_offset=100.0)
LINE = [(5.0, 7.0), (31.0, 15.0), (44.0, 30.0)]
RING = [(5.0, 5.0), (40.0, 7.0), (30.0, 33.0)]
REFERENCE = (2.0, 6.0, 3.0)


def ground(rng: np.random.Generator) -> np.ndarray:
    return rng.uniform(0.0, 10.0, GRID.shape).astype(np.float32)


def expected_bed(z_b: np.ndarray, edit: Edit) -> np.ndarray:
    """The formulas in plain Python, one cell after the other, rounded where the contract says."""
    z_b = z_b.copy()
    rows, cols, position = rasterise_edit(edit, GRID)
    sign = 1.0 if edit.operation == "raise" else -1.0
    for k, (row, col) in enumerate(zip(rows.tolist(), cols.tolist(), strict=True)):
        z = z_b[row, col]
        if edit.type == "modulate":
            z_b[row, col] = z + np.float32(sign * edit.magnitude)
            continue
        if edit.level is not None:
            target = edit.level - GRID.datum_offset
        else:
            assert edit.reference_z is not None
            if position is None:
                reference = sum(edit.reference_z) / len(edit.reference_z)
            else:
                start = min(int(position[k]), len(edit.reference_z) - 2)
                low, high = edit.reference_z[start : start + 2]
                reference = low + (high - low) * (float(position[k]) - start)
            target = reference + sign * edit.magnitude
        z_b[row, col] = max(z, np.float32(target)) if sign > 0 else min(z, np.float32(target))
    return z_b


@pytest.mark.parametrize(
    "make", [lambda **k: line(LINE, 5.0, **k), lambda **k: area(RING, **k)], ids=["line", "area"]
)
@pytest.mark.parametrize("operation", ["raise", "lower"])
@pytest.mark.parametrize(
    "kind",
    [
        {"type": "modulate", "magnitude": 1.7},
        {"type": "modulate", "magnitude": 1.7, "level": 105.0, "reference_z": REFERENCE},
        {"type": "replace", "magnitude": 0.7, "reference_z": REFERENCE},
        {"type": "replace", "magnitude": 0.7, "level": 105.3},
        {"type": "replace", "magnitude": 0.7, "level": 105.3, "reference_z": REFERENCE},
    ],
    ids=["modulate", "modulate-ignores-targets", "replace", "replace-at-level", "level-wins"],
)
def test_the_bed_follows_the_formulas_bit_for_bit(make, operation, kind, rng) -> None:  # type: ignore[no-untyped-def]
    z_b = ground(rng)
    edit = make(operation=operation, **kind)
    edited = apply_edits(z_b, [edit], GRID)
    assert edited.z_b.dtype == np.float32
    assert edited.z_b.tobytes() == expected_bed(z_b, edit).tobytes()
    assert (edited.z_b != z_b).any()


def test_edits_apply_in_list_order(rng: np.random.Generator) -> None:
    z_b = ground(rng)
    first = line(LINE, 5.0, id="1", type="replace", level=112.0)
    second = area(RING, id="2", operation="lower", magnitude=2.5)
    forth, back = (apply_edits(z_b, edits, GRID).z_b for edits in ([first, second], [second, first]))
    np.testing.assert_array_equal(forth, expected_bed(expected_bed(z_b, first), second))
    assert (forth != back).any()


def test_the_list_may_be_applied_in_two_goes(rng: np.random.Generator) -> None:
    z_b = ground(rng)
    edits = [line(LINE, 5.0, id="1"), area(RING, id="2"), line(LINE[::-1], 9.0, id="3", operation="lower")]
    whole = apply_edits(z_b, edits, GRID).z_b
    in_two = apply_edits(apply_edits(z_b, edits[:1], GRID).z_b, edits[1:], GRID).z_b
    assert whole.tobytes() == in_two.tobytes()


def test_the_base_stays_as_it_is(rng: np.random.Generator) -> None:
    z_b = ground(rng)
    before = z_b.copy()
    edited = apply_edits(z_b, [line(LINE)], GRID)
    np.testing.assert_array_equal(z_b, before)
    assert not np.shares_memory(edited.z_b, z_b)


def test_no_edit_changes_nothing(rng: np.random.Generator) -> None:
    z_b = ground(rng)
    edited = apply_edits(z_b, [], GRID)
    assert edited.z_b.tobytes() == z_b.tobytes()
    assert edited.dirty is None
    assert edited.raised.size == 0
    assert not np.shares_memory(edited.z_b, z_b)


@given(st.integers(0, 2**32 - 1))
def test_only_the_dirty_rectangle_changes_and_its_signs_say_how(seed: int) -> None:
    rng = np.random.default_rng(seed)
    z_b = ground(rng)
    xs, ys = rng.uniform(0, 60, 6), rng.uniform(0, 40, 6)
    vertices = list(zip(xs.tolist(), ys.tolist(), strict=True))
    edits = [
        line(vertices[:3], 3.0, id="1", type="replace", reference_z=(4.0, 6.0, 5.0)),
        area(vertices[3:], id="2", operation="lower", type="replace", level=103.0),
    ]
    edited = apply_edits(z_b, edits, GRID)
    assert edited.dirty is not None
    row0, row1, col0, col1 = edited.dirty
    signs = np.zeros(GRID.shape, dtype=np.int8)
    signs[row0:row1, col0:col1] = edited.raised
    np.testing.assert_array_equal(signs, np.sign(edited.z_b - z_b))
    covered = np.zeros(GRID.shape, dtype=bool)
    for edit in edits:
        rows, cols, _ = rasterise_edit(edit, GRID)
        covered[rows, cols] = True
    assert not (signs[~covered]).any()
    rows, cols = np.nonzero(covered)
    assert edited.dirty == (rows.min(), rows.max() + 1, cols.min(), cols.max() + 1)


def test_a_crest_between_vertices_follows_the_line_through_the_ground_there() -> None:
    edit = line([(1.0, 21.0), (59.0, 21.0)], 0.5, type="replace", magnitude=2.0, reference_z=(0.0, 29.0))
    crest = apply_edits(np.full(GRID.shape, -50.0), [edit], GRID).z_b[10]
    np.testing.assert_allclose(crest, np.arange(30) + 2.0, atol=1e-3)


def test_a_level_is_a_real_elevation() -> None:
    edit = line(LINE, 5.0, type="replace", level=104.0)
    assert apply_edits(np.zeros(GRID.shape), [edit], GRID).z_b.max() == 4.0


def test_an_edit_that_covers_no_cell_changes_nothing() -> None:
    tiny = area([(10.1, 10.1), (10.2, 10.1), (10.2, 10.2)])
    assert apply_edits(np.zeros(GRID.shape), [tiny], GRID).dirty is None


def test_a_bed_of_another_shape_is_refused() -> None:
    with pytest.raises(EditError, match="shape"):
        apply_edits(np.zeros((30, 20)), [], GRID)
