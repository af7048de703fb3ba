"""Blocks against loops over vertices."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from protocol import BlockLayout, BlockState, FrameError

sides = st.one_of(st.integers(1, 100), st.sampled_from([1, 2, 31, 32, 33, 34, 63, 64, 65, 66, 96, 97]))


def spans(vertex_count: int) -> list[range]:
    """Vertices of each block along one side, by the definition."""
    block_count = max(1, -(-(vertex_count - 1) // 32))
    return [range(32 * i, min(32 * (i + 1), vertex_count - 1) + 1) for i in range(block_count)]


def classify_slowly(q: np.ndarray) -> list[list[int]]:
    states = []
    for rows in spans(q.shape[0]):
        states.append([])
        for cols in spans(q.shape[1]):
            wet = [q[row, col] > 0 for row in rows for col in cols]
            states[-1].append(2 if all(wet) else 1 if any(wet) else 0)
    return states


def random_water(rng: np.random.Generator, nrows: int, ncols: int) -> np.ndarray:
    """Water whose blocks are dry, wet or mixed, with single odd cells at the edges that blocks share."""
    q = np.zeros((nrows, ncols), dtype=np.uint16)
    for rows in spans(nrows):
        for cols in spans(ncols):
            q[rows.start : rows.stop, cols.start : cols.stop] = rng.integers(0, 2) * 65535
    for _ in range(rng.integers(0, 4)):
        row, col = rng.integers(0, nrows), rng.integers(0, ncols)
        q[min(row // 32 * 32, nrows - 1), col] = rng.integers(0, 2)
        q[row, min(col // 32 * 32, ncols - 1)] = rng.integers(0, 2)
    return q


@given(sides, sides, st.integers(0, 2**32 - 1))
def test_states_are_those_of_a_loop_over_all_vertices(nrows: int, ncols: int, seed: int) -> None:
    q = random_water(np.random.default_rng(seed), nrows, ncols)
    assert BlockLayout(nrows, ncols).classify(q).tolist() == classify_slowly(q)


@pytest.mark.parametrize(("row", "col"), [(32, 10), (10, 32), (32, 32), (64, 64), (0, 0)])
def test_a_wet_vertex_on_a_shared_edge_counts_for_every_block_that_has_it(row: int, col: int) -> None:
    q = np.zeros((70, 70), dtype=np.uint16)
    q[row, col] = 1
    states = BlockLayout(70, 70).classify(q)
    expected = [
        [int(row in rows and col in cols) * BlockState.PARTIAL for cols in spans(70)] for rows in spans(70)
    ]
    assert states.tolist() == expected


@given(sides, sides)
def test_block_counts_and_owners_follow_their_definition(nrows: int, ncols: int) -> None:
    layout = BlockLayout(nrows, ncols)
    assert layout.shape == (len(spans(nrows)), len(spans(ncols)))
    assert layout.block_count == layout.block_rows * layout.block_cols
    assert layout.row_owner.tolist() == [min(i // 32, layout.block_rows - 1) for i in range(nrows)]
    assert layout.col_owner.tolist() == [min(i // 32, layout.block_cols - 1) for i in range(ncols)]


@given(sides, sides, st.integers(0, 2**32 - 1))
def test_owned_cells_are_those_whose_owner_is_not_dry(nrows: int, ncols: int, seed: int) -> None:
    layout = BlockLayout(nrows, ncols)
    states = np.random.default_rng(seed).integers(0, 3, layout.shape).astype(np.uint8)
    mask = layout.owned_mask(states)
    expected = states[layout.row_owner[:, None], layout.col_owner[None, :]] != BlockState.DRY
    np.testing.assert_array_equal(mask, expected)
    assert layout.owned_count(states) == expected.sum()


@given(sides, sides, st.integers(0, 2**32 - 1))
def test_owned_cells_are_gathered_row_by_row_and_scattered_back(nrows: int, ncols: int, seed: int) -> None:
    layout, rng = BlockLayout(nrows, ncols), np.random.default_rng(seed)
    states = rng.integers(0, 2, layout.shape).astype(np.uint8)
    mask = layout.owned_mask(states)
    raster = rng.random((nrows, ncols))
    cells = layout.gather(raster, states)
    np.testing.assert_array_equal(cells, raster[mask])
    back = np.full((nrows, ncols), -1.0)
    layout.scatter(cells, states, back)
    np.testing.assert_array_equal(back, np.where(mask, raster, -1.0))


@given(sides, sides, st.integers(0, 2**32 - 1))
def test_no_wet_cell_is_left_out_of_the_owned_ones(nrows: int, ncols: int, seed: int) -> None:
    layout = BlockLayout(nrows, ncols)
    q = random_water(np.random.default_rng(seed), nrows, ncols)
    assert not (q[~layout.owned_mask(layout.classify(q))] > 0).any()


@given(sides, sides, st.integers(0, 2**32 - 1))
def test_packed_states_come_back(nrows: int, ncols: int, seed: int) -> None:
    layout = BlockLayout(nrows, ncols)
    states = np.random.default_rng(seed).integers(0, 3, layout.shape).astype(np.uint8)
    packed = layout.pack_states(states)
    assert len(packed) == layout.packed_size
    np.testing.assert_array_equal(layout.unpack_states(packed), states)


def test_states_are_packed_two_bits_a_block_the_first_lowest() -> None:
    assert BlockLayout(33, 161).pack_states([[2, 1, 0, 2, 1]]) == bytes([0b10_00_01_10, 0b01])


@pytest.mark.parametrize("packed", [b"", b"\x00", b"\x00\x00\x00", b"\x03\x00", b"\x00\x04", b"\x00\xff"])
def test_states_that_do_not_fit_the_layout_are_refused(packed: bytes) -> None:
    with pytest.raises(FrameError):
        BlockLayout(33, 161).unpack_states(packed)


def test_depths_of_another_shape_are_refused() -> None:
    with pytest.raises(FrameError, match="shape"):
        BlockLayout(33, 161).classify(np.zeros((161, 33), dtype=np.uint16))
