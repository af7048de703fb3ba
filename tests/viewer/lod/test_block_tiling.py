import numpy as np
import pytest

from protocol import BlockLayout
from viewer.lod import BlockTiling, classify_blocks

SIZES = [(33, 33), (34, 65), (257, 321), (2, 2), (100, 40), (64, 97)]


@pytest.mark.parametrize(("nrows", "ncols"), SIZES)
def test_every_vertex_lies_in_a_block_and_neighbours_share_their_edge(nrows: int, ncols: int) -> None:
    tiling = BlockTiling(nrows, ncols)

    assert tiling.row_start[0] == 0
    assert tiling.row_end[-1] == nrows - 1
    assert (tiling.row_start[1:] == tiling.row_end[:-1]).all()
    assert (tiling.col_start[1:] == tiling.col_end[:-1]).all()
    assert (tiling.row_end > tiling.row_start).all()
    assert (tiling.col_end > tiling.col_start).all()


@pytest.mark.parametrize(("nrows", "ncols"), SIZES)
def test_blocks_of_33_are_the_blocks_of_the_wire(nrows: int, ncols: int) -> None:
    tiling, layout = BlockTiling(nrows, ncols), BlockLayout(nrows, ncols)

    assert (tiling.block_rows, tiling.block_cols) == (layout.block_rows, layout.block_cols)


@pytest.mark.parametrize("block_size", [17, 33, 65])
def test_a_block_has_levels_down_to_one_square(block_size: int) -> None:
    tiling = BlockTiling(257, 257, block_size)

    assert 1 << (tiling.level_count - 1) == tiling.stride
    assert (tiling.triangle_counts[-1] == 2).all()
    assert tiling.triangle_counts[0].sum() == 2 * 256 * 256


def test_a_reduction_covers_shared_edges(rng: np.random.Generator) -> None:
    values = rng.normal(size=(100, 75))
    tiling = BlockTiling(100, 75, 17)
    expected = [
        [
            values[
                tiling.row_start[i] : tiling.row_end[i] + 1, tiling.col_start[j] : tiling.col_end[j] + 1
            ].max()
            for j in range(tiling.block_cols)
        ]
        for i in range(tiling.block_rows)
    ]

    assert tiling.reduce(np.maximum, values).tolist() == expected


def test_ragged_blocks_count_only_triangles_with_an_area() -> None:
    tiling = BlockTiling(33 + 5, 33)

    assert tiling.triangle_counts[:, 1].tolist() == [2 * 5 * 32, 2 * 3 * 16, 2 * 2 * 8, 2 * 4, 2 * 2, 2]


def test_a_changed_rectangle_touches_the_blocks_that_hold_a_vertex_of_it() -> None:
    tiling = BlockTiling(129, 129)

    assert tiling.blocks_touching((40, 40, 41, 41)) == (1, 1, 2, 2)
    assert tiling.blocks_touching((32, 40, 33, 41)) == (0, 1, 2, 2)
    assert tiling.blocks_touching((0, 0, 129, 129)) == (0, 0, 4, 4)
    assert tiling.blocks_touching((31, 0, 34, 1)) == (0, 0, 2, 1)


def test_depths_are_classified_as_on_the_wire(rng: np.random.Generator) -> None:
    h = (rng.random((110, 75)) - 0.2).clip(0.0).astype(np.float32)
    h[:40, :40] = 1.0
    h[70:, 30:] = 0.0
    quantised = np.where(h > 0.0, np.maximum(np.rint(h * 1000.0), 1), 0).astype(np.uint16)
    states = classify_blocks(h, BlockTiling(110, 75))

    assert set(states.ravel().tolist()) == {0, 1, 2}
    assert np.array_equal(states, BlockLayout(110, 75).classify(quantised))


@pytest.mark.parametrize("arguments", [(1, 50), (50, 1), (50, 50, 32), (50, 50, 129)])
def test_a_tiling_without_triangles_or_of_another_block_size_is_refused(arguments: tuple[int, ...]) -> None:
    with pytest.raises(ValueError, match=r"least|not one of"):
        BlockTiling(*arguments)
