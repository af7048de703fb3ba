"""What is drawn in one picture: which blocks, and at which level."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from viewer.lod.block_tiling import BlockTiling

__all__ = ["INSTANCE_DTYPE", "LodStats", "Selection", "count_triangles"]

Instances = npt.NDArray[np.void]

INSTANCE_DTYPE = np.dtype(
    [("col", "<u2"), ("row", "<u2"), ("w", "u1"), ("e", "u1"), ("s", "u1"), ("n", "u1")]
)
"""One drawn block: its place among the blocks, and the level to which each edge is fitted."""


@dataclass(frozen=True)
class LodStats:
    """What a selection draws."""

    terrain_triangles: int
    """Triangles with an area, edges fitted to coarser neighbours counted as they are drawn."""
    water_triangles: int
    terrain_blocks: int
    water_blocks: int
    culled_blocks: int
    """Blocks outside of the view."""
    covered_blocks: int
    """Blocks in view whose terrain is not drawn because water covers all of it."""


@dataclass(frozen=True)
class Selection:
    """The blocks of one picture."""

    level: npt.NDArray[np.uint8]
    """Level of every block that may be in view, shape [block_count]; of others it says nothing."""
    visible: npt.NDArray[np.bool_]
    """Whether a block may be in view, shape [block_count]."""
    terrain: tuple[Instances, ...]
    """Instances of terrain blocks by level, each of `INSTANCE_DTYPE`."""
    water: tuple[Instances, ...]
    """Instances of water blocks by level."""
    distance_min: float
    """From the eye to the nearest box in view [m]; infinite if none is."""
    distance_max: float
    """From the eye to the farthest point of a box in view [m]; 0 if none is."""
    stats: LodStats


def count_triangles(tiling: BlockTiling, instances: Instances, level: npt.NDArray[np.uint8]) -> int:
    """Triangles with an area of some blocks: each vertex that an edge gives up leaves one triangle without.

    Args:
        tiling: the blocks.
        instances: blocks of `INSTANCE_DTYPE`, shape [n].
        level: their levels, shape [n].
    """
    rows, cols = instances["row"].astype(np.int64), instances["col"].astype(np.int64)
    count = int(tiling.triangle_counts[level, rows * tiling.block_cols + cols].sum())
    height = (tiling.row_end - tiling.row_start)[rows]
    width = (tiling.col_end - tiling.col_start)[cols]
    for edge, length in (("w", height), ("e", height), ("s", width), ("n", width)):
        # A shift of the negated length rounds upwards.
        count += int(((-length >> level) - (-length >> instances[edge])).sum())
    return count
