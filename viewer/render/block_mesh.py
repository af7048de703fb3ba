"""The triangles of a block at each level, and the instance buffers that say where blocks are drawn."""

from __future__ import annotations

from collections.abc import Sequence

import moderngl
import numpy as np
import numpy.typing as npt

from viewer.lod.selection import INSTANCE_DTYPE
from viewer.render.shader_library import set_uniforms

__all__ = ["BlockIndices", "BlockInstances", "block_triangles"]


def block_triangles(block_size: int, level: int) -> npt.NDArray[np.uint16]:
    """Vertices (row-major in a block) of its triangles at a level, split from south-west to north-east."""
    step = 1 << level
    at = np.arange(0, block_size - 1, step)
    rows, cols = np.meshgrid(at, at, indexing="ij")
    south_west = (rows * block_size + cols).ravel()
    south_east, north_west = south_west + step, south_west + step * block_size
    north_east = north_west + step
    corners = [south_west, south_east, north_east, south_west, north_east, north_west]
    return np.stack(corners, axis=1).ravel().astype("<u2")


class BlockIndices:
    """One index buffer a level, shared by all passes that draw blocks."""

    def __init__(self, ctx: moderngl.Context, block_size: int, level_count: int) -> None:
        """Upload the indices of all levels."""
        self.buffers = [ctx.buffer(block_triangles(block_size, level)) for level in range(level_count)]

    def release(self) -> None:
        """Give the memory back."""
        for buffer in self.buffers:
            buffer.release()


class BlockInstances:
    """Draws blocks with one program: an instance buffer and a vertex array a level, one draw a level."""

    def __init__(
        self, ctx: moderngl.Context, program: moderngl.Program, indices: BlockIndices, block_count: int
    ) -> None:
        """Allocate room for every block at every level."""
        self._program = program
        self._capacity = block_count * INSTANCE_DTYPE.itemsize
        self._buffers = [ctx.buffer(reserve=self._capacity, dynamic=True) for _ in indices.buffers]
        self._arrays = [
            ctx.vertex_array(
                program,
                [(buffer, "2u2 4u1 /i", "in_block", "in_edges")],
                index_buffer=index_buffer,
                index_element_size=2,
            )
            for buffer, index_buffer in zip(self._buffers, indices.buffers, strict=True)
        ]

    def draw(self, by_level: Sequence[npt.NDArray[np.void]]) -> int:
        """Draw the blocks of each level, and return the number of draws."""
        draws = 0
        for level, instances in enumerate(by_level):
            if instances.size:
                self._buffers[level].orphan(self._capacity)
                self._buffers[level].write(instances)
                set_uniforms(self._program, level=level)
                self._arrays[level].render(moderngl.TRIANGLES, instances=instances.size)
                draws += 1
        return draws

    def release(self) -> None:
        """Give the memory back."""
        for array, buffer in zip(self._arrays, self._buffers, strict=True):
            array.release()
            buffer.release()
