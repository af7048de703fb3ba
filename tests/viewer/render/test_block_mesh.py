import moderngl
import numpy as np
import pytest

from viewer.lod.selection import INSTANCE_DTYPE
from viewer.render.block_mesh import BlockIndices, block_triangles


@pytest.mark.parametrize("block_size", [17, 33, 65])
def test_triangles_of_every_level_tile_the_block_once(block_size: int) -> None:
    for level in range(block_size.bit_length()):
        if 1 << level > block_size - 1:
            break
        triangles = block_triangles(block_size, level).reshape(-1, 3).astype(int)
        rows, cols = np.divmod(triangles, block_size)
        doubled = (cols[:, 1] - cols[:, 0]) * (rows[:, 2] - rows[:, 0])
        doubled -= (cols[:, 2] - cols[:, 0]) * (rows[:, 1] - rows[:, 0])

        assert (doubled == (1 << level) ** 2).all()  # seen from above all turn the same way
        assert doubled.sum() == 2 * (block_size - 1) ** 2


def test_squares_are_split_from_south_west_to_north_east() -> None:
    triangles = block_triangles(17, 4).reshape(-1, 3).tolist()

    assert triangles == [[0, 16, 17 * 17 - 1], [0, 17 * 17 - 1, 17 * 16]]


def test_an_instance_is_eight_bytes() -> None:
    assert INSTANCE_DTYPE.itemsize == 8


@pytest.mark.gl
def test_every_level_has_its_index_buffer(ctx: moderngl.Context) -> None:
    indices = BlockIndices(ctx, 33, 6)

    assert [buffer.size for buffer in indices.buffers] == [12 * (32 >> level) ** 2 for level in range(6)]
    indices.release()
