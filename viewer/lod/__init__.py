"""Level of detail: which block is drawn how finely; NumPy in, numbers out, no OpenGL."""

from viewer.lod.block_errors import BlockBounds, block_bounds, block_errors
from viewer.lod.block_selector import BlockSelector
from viewer.lod.block_tiling import BLOCK_SIZES, BlockTiling, Border, classify_blocks
from viewer.lod.edge_errors import edge_errors
from viewer.lod.quadtree import BlockQuadtree
from viewer.lod.selection import LodStats, Selection
from viewer.lod.switch_table import SwitchTable, pixels_per_slope, screen_error_factor

__all__ = [
    "BLOCK_SIZES",
    "BlockBounds",
    "BlockQuadtree",
    "BlockSelector",
    "BlockTiling",
    "Border",
    "LodStats",
    "Selection",
    "SwitchTable",
    "block_bounds",
    "block_errors",
    "classify_blocks",
    "edge_errors",
    "pixels_per_slope",
    "screen_error_factor",
]
