import numpy as np
import pytest

from protocol import BlockLayout
from tests.viewer.conftest import hills
from viewer.lod import BlockTiling, Border, block_errors, classify_blocks, edge_errors

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


# --- borders -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("block_size", [17, 33, 65])
@pytest.mark.parametrize("border", list(Border))
@pytest.mark.parametrize("shape", [(70, 150), (33, 65), (20, 131)])
def test_blocks_of_any_size_and_border_are_classified_as_their_vertices_are(
    block_size: int, border: Border, shape: tuple[int, int]
) -> None:
    rng = np.random.default_rng(block_size)
    tiling = BlockTiling(*shape, block_size, border)
    # Patches of water, so that all three classes come up.
    coarse = rng.random((-(-shape[0] // 12), -(-shape[1] // 12))) < 0.6
    h = np.repeat(np.repeat(coarse, 12, axis=0), 12, axis=1)[: shape[0], : shape[1]].astype(np.float32)
    h[: shape[0] // 2, : 2 * shape[1] // 3] = 1.0
    states = classify_blocks(h, tiling)

    assert states.shape == (tiling.block_rows, tiling.block_cols)
    for row in range(tiling.block_rows):
        for col in range(tiling.block_cols):
            rows = slice(row * tiling.stride, row * tiling.stride + block_size)
            wet = h[rows, col * tiling.stride : col * tiling.stride + block_size] > 0.0
            assert states[row, col] == int(wet.any()) + int(wet.all())


@pytest.mark.parametrize("block_size", [17, 33, 65])
def test_borders_cut_off_fill_up_or_leave_what_fills_no_block(block_size: int) -> None:
    stride = block_size - 1
    nrows, ncols = 3 * stride + 1, 2 * stride + 8
    ragged, trimmed, padded = (BlockTiling(nrows, ncols, block_size, border) for border in Border)

    assert (ragged.drawn_rows, ragged.drawn_cols, ragged.block_cols) == (nrows, ncols, 3)
    assert (trimmed.drawn_rows, trimmed.drawn_cols, trimmed.block_cols) == (nrows, 2 * stride + 1, 2)
    assert (padded.drawn_rows, padded.drawn_cols, padded.block_cols) == (nrows, 3 * stride + 1, 3)
    z = np.arange(nrows * ncols, dtype=np.float32).reshape(nrows, ncols)
    assert ragged.fitted(z) is z or np.shares_memory(ragged.fitted(z), z)
    assert np.array_equal(trimmed.fitted(z), z[:, : 2 * stride + 1])
    assert np.array_equal(padded.fitted(z)[:, ncols:], np.repeat(z[:, -1:], 3 * stride + 1 - ncols, axis=1))


def test_a_raster_smaller_than_a_block_is_not_trimmed_away() -> None:
    tiling = BlockTiling(9, 12, 33, Border.TRIM)
    assert (tiling.block_count, tiling.drawn_rows, tiling.drawn_cols) == (1, 9, 12)
    assert tiling.triangle_counts[0].sum() == 2 * 8 * 11


@pytest.mark.parametrize("border", [Border.TRIM, Border.PAD])
def test_errors_are_those_of_the_raster_as_it_is_drawn(border: Border) -> None:
    z = hills(75, 110, 10.0, 60.0)
    tiling = BlockTiling(75, 110, 17, border)
    whole = tiling.fitted(z)
    plain = BlockTiling(*whole.shape, 17)
    errors = block_errors(z, tiling)

    assert np.array_equal(errors, block_errors(whole, plain))
    assert np.array_equal(edge_errors(z, tiling, errors), edge_errors(whole, plain, errors))
    assert errors.shape[1:] == (tiling.block_rows, tiling.block_cols)
