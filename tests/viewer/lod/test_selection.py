import numpy as np
import pytest

from viewer.lod import BlockTiling
from viewer.lod.selection import INSTANCE_DTYPE, count_triangles
from viewer.render.block_mesh import block_triangles


def drawn_triangles(tiling: BlockTiling, instance: np.void, level: int) -> int:
    """Triangles with an area of one block, corner by corner, as the vertex shader places them."""
    size, stride = tiling.block_size, tiling.stride
    corners = block_triangles(size, level).astype(np.int64)
    y, x = np.divmod(corners, size)
    row, col = y.copy(), x.copy()
    for edge, at, line, moved in (
        ("w", x, 0, row),
        ("e", x, stride, row),
        ("s", y, 0, col),
        ("n", y, stride, col),
    ):
        on_edge = at == line
        moved[on_edge] = (moved[on_edge] >> int(instance[edge])) << int(instance[edge])
    row = np.minimum(int(instance["row"]) * stride + row, tiling.drawn_rows - 1).reshape(-1, 3)
    col = np.minimum(int(instance["col"]) * stride + col, tiling.drawn_cols - 1).reshape(-1, 3)
    area = (col[:, 1] - col[:, 0]) * (row[:, 2] - row[:, 0]) - (col[:, 2] - col[:, 0]) * (
        row[:, 1] - row[:, 0]
    )
    return int((area != 0).sum())


@pytest.mark.parametrize("block_size", [17, 33, 65])
def test_the_count_is_that_of_the_triangles_with_an_area(block_size: int) -> None:
    rng = np.random.default_rng(block_size)
    tiling = BlockTiling(150, 113, block_size)
    instances = np.zeros(40, INSTANCE_DTYPE)
    instances["row"] = rng.integers(0, tiling.block_rows, 40)
    instances["col"] = rng.integers(0, tiling.block_cols, 40)
    level = rng.integers(0, tiling.level_count, 40).astype(np.uint8)
    for edge in "wesn":
        instances[edge] = np.maximum(level, rng.integers(0, tiling.level_count, 40))
    # Beyond the border of the map lies no coarser block.
    for edge, last in (
        ("n", instances["row"] == tiling.block_rows - 1),
        ("e", instances["col"] == tiling.block_cols - 1),
    ):
        instances[edge][last] = level[last]

    expected = sum(drawn_triangles(tiling, one, int(at)) for one, at in zip(instances, level, strict=True))
    assert count_triangles(tiling, instances, level) == expected
    unfitted = instances.copy()
    for edge in "wesn":
        unfitted[edge] = level
    assert count_triangles(tiling, unfitted, level) > expected
