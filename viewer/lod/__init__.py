"""Level of detail: which block is drawn how finely; NumPy in, numbers out, no OpenGL."""

from viewer.lod.block_errors import BlockBounds, block_bounds, block_errors
from viewer.lod.block_tiling import BlockTiling, classify_blocks
from viewer.lod.edge_errors import edge_errors
from viewer.lod.selection import BlockSelector, LodStats, Selection
from viewer.lod.switch_table import SwitchTable, pixels_per_slope, screen_error_factor

__all__ = [
    "BlockBounds",
    "BlockSelector",
    "BlockTiling",
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
